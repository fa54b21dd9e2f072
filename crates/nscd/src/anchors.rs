//! Springs that hold a body which supports leave free to move as a whole, while Newton's method corrects it.
//!
//! There are as few of them as the body has rigid motions left, on single unknowns of its nodes: a statically
//! determinate support. Forces in equilibrium load none of these springs, whatever their stiffness, and the body
//! deforms as if it were free; a resultant moves it as a whole by the force over the stiffness. The residual knows no
//! springs, so that their forces vanish with the corrections and no part of them is left in an accepted step: what
//! holds the body there are its contacts and bonds alone.

use fe_core::Symmetry;
use nalgebra::Vector3;

use crate::floating::loose_unknowns;
use crate::linear::LowerPattern;
use crate::model::Model;

/// Stiffness of the springs over that of the softest body in shear \[-\]: what holds the body is about as stiff as
/// that, and each correction leaves about this part of the rigid motion that it should have made. Much less would cost
/// digits in the compliance of the surface.
const SOFTNESS: f64 = 1e-2;
/// Factor of the stiffness where the matrix is not definite with the springs \[-\]: a body that is pressed together
/// would turn over.
const STIFFER: f64 = 10.0;
/// How often they are made stiffer: up to the body.
const TRIES: usize = 2;

/// The springs of one body.
#[derive(Debug, Default)]
pub(crate) struct Anchors {
    /// Equations with a spring; none where supports hold the body.
    equations: Vec<usize>,
    /// Stiffness of the body in shear \[N/m\]; zero before it is known.
    body: f64,
    /// That of the softest body \[N/m\].
    softest: f64,
    /// Stiffness of the springs in the matrix \[N/m\].
    stiffness: f64,
    /// Whether the body may turn.
    turns: bool,
    /// What a unit force on each spring moves, flat \[m/N\]; empty until it is asked for.
    motions: Vec<Vec<f64>>,
}

impl Anchors {
    /// For the body with these nodes and these unknowns in the order of its equations.
    pub(crate) fn of(model: &Model, nodes: &[u32], fixed: &[bool], dofs: &[u32]) -> Self {
        let loose = loose_unknowns(model, nodes, fixed);
        let equation = |d: &u32| dofs.iter().position(|x| x == d);
        Self {
            equations: loose.iter().filter_map(equation).collect(),
            turns: model.solid.mesh().symmetry != Symmetry::Axisymmetric,
            ..Self::default()
        }
    }

    /// Whether supports alone hold the body.
    pub(crate) fn is_empty(&self) -> bool {
        self.equations.is_empty()
    }

    /// Equations with a spring.
    pub(crate) fn equations(&self) -> &[usize] {
        &self.equations
    }

    /// Whether the stiffness of the body in shear is known.
    pub(crate) fn is_measured(&self) -> bool {
        self.body > 0.0
    }

    /// Finds the stiffness of the body in the motions `shears`, from its first matrix, which has the given lower
    /// triangle and largest diagonal entry \[N/m\].
    pub(crate) fn measure(
        &mut self,
        shears: &[Vec<f64>],
        pattern: LowerPattern<'_>,
        values: &[f64],
        largest: f64,
    ) {
        let energies = shears.iter().map(|u| pattern.energy(values, u));
        let positive = energies.filter(|e| *e > 0.0);
        self.body = positive.fold(largest, f64::min);
    }

    /// Stiffness of the body in shear \[N/m\]; zero before it is known.
    pub(crate) fn own_stiffness(&self) -> f64 {
        self.body
    }

    /// Tells the stiffness of the softest body \[N/m\].
    pub(crate) fn compare(&mut self, softest: f64) {
        self.softest = softest;
    }

    /// Puts the springs into a new matrix.
    pub(crate) fn enter(&mut self, pattern: LowerPattern<'_>, values: &mut [f64]) {
        self.motions.clear();
        self.stiffness = SOFTNESS * self.softest;
        self.add(pattern, values, self.stiffness);
    }

    /// Makes the springs of a matrix stiffer that is not definite with them, the `attempt`-th time from zero; `false`
    /// where that was tried often enough.
    pub(crate) fn stiffen(
        &mut self,
        attempt: usize,
        pattern: LowerPattern<'_>,
        values: &mut [f64],
    ) -> bool {
        if self.is_empty() || !self.turns || attempt >= TRIES {
            return false;
        }
        let more = (STIFFER - 1.0) * self.stiffness;
        self.add(pattern, values, more);
        self.stiffness += more;
        true
    }

    fn add(&self, pattern: LowerPattern<'_>, values: &mut [f64], stiffness: f64) {
        for &equation in &self.equations {
            values[pattern.pointers[equation]] += stiffness;
        }
    }

    /// Remembers what a unit force on each spring moves \[m/N\].
    pub(crate) fn set_motions(&mut self, motions: Vec<Vec<f64>>) {
        self.motions = motions;
    }

    /// What a unit force on each spring moves, flat \[m/N\].
    pub(crate) fn motions(&self) -> &[Vec<f64>] {
        &self.motions
    }

    /// How much of the compliance along a motion that a unit force makes belongs to the softness of the springs, those
    /// as stiff as the body left to it, over the square of that motion \[N/m\].
    pub(crate) fn excess(&self) -> f64 {
        self.stiffness * (1.0 - (self.stiffness / self.body).min(1.0))
    }
}

/// The motions `u_i = x_j` of the plane or of space, over the size of the body with this index, at the unknowns `dofs`:
/// they keep the volume, so that they tell the stiffness of nearly incompressible bodies too.
pub(crate) fn shears(model: &Model, body: usize, dofs: &[u32]) -> Vec<Vec<f64>> {
    let (mesh, nodes) = (model.solid.mesh(), &model.solid.bodies()[body]);
    let dim = model.solid.dim();
    let places = nodes.iter().map(|&n| mesh.points[n as usize]);
    let center = places.clone().sum::<Vector3<f64>>() / nodes.len().max(1) as f64;
    let size = places.map(|x| (x - center).amax());
    let size = size.fold(f64::MIN_POSITIVE, f64::max);
    let shear = |i: usize, j: usize| {
        let at = |&d: &u32| {
            let (node, component) = (d as usize / dim, d as usize % dim);
            match component == i {
                true => (mesh.points[node][j] - center[j]) / size,
                false => 0.0,
            }
        };
        dofs.iter().map(at).collect()
    };
    let pairs = (0..dim).flat_map(|i| (0..dim).map(move |j| (i, j)));
    // A motion along the radius that grows along the axis strains the rings.
    let keeps_volume =
        |(i, j): &(usize, usize)| i != j && (mesh.symmetry != Symmetry::Axisymmetric || *i == 1);
    pairs
        .filter(keeps_volume)
        .map(|(i, j)| shear(i, j))
        .collect()
}
