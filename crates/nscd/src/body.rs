//! The linear system of one body: equations, matrix, factor and condensed surface.

use contact_bipotential::CompliancePart;
use fe_core::{Solid, SymmetricPattern, node_adjacency};

use crate::anchors::{Anchors, shears};
use crate::contact_stiffness::{ContactStiffness, augment};
use crate::cost::COSTS;
use crate::elements::Elements;
use crate::error::{NscdError, StepFailure};
use crate::flat::{equations, norm};
use crate::linear::{Condensed, Factor, Indefinite, LowerPattern};
use crate::model::Model;
use crate::ordering::{Graph, elimination_order};
use crate::report::Counters;
use crate::scheme::{Inertia, Weights};

/// Relative residual of a linear solve that needs no refinement \[-\].
const GOOD_SOLVE: f64 = 1e-10;
/// Relative residual of a linear solve after refinement that is still believed \[-\].
const LAST_SOLVE: f64 = 1e-6;
/// Solves of one right hand side, the refinements included.
const SOLVES: usize = 3;
/// Part of the diagonal that an indefinite matrix is first shifted by \[-\].
const FIRST_SHIFT: f64 = 1e-4;
/// Factor from one shift to the next \[-\]: few tries, and hardly more than ten times what suffices.
const NEXT_SHIFT: f64 = 10.0;
/// A matrix that is indefinite after a shift beyond this part of its diagonal is given up \[-\].
const LAST_SHIFT: f64 = 10.0;

/// One connected body and its factorized tangent, which may be older than the state: the
/// residual is always exact, so an old tangent costs iterations and never accuracy.
#[derive(Debug)]
pub(crate) struct BodySystem {
    index: usize,
    /// Unknowns a node, of which some may be prescribed.
    dim: usize,
    /// Springs where without mass supports alone do not hold the body: some rigid motion costs no force.
    anchors: Anchors,
    /// Global dof of each equation.
    pub(crate) dofs: Vec<u32>,
    pattern: SymmetricPattern,
    values: Vec<f64>,
    factor: Factor,
    /// First equation of a contact candidate.
    first_candidate: usize,
    condensed: Option<CompliancePart>,
    surface: Option<Condensed>,
    /// Weights of the factor in use; `None` when there is none.
    factored: Option<Weights>,
    contraction: Option<f64>,
    /// Stiffness of contacts in the factor in use; the matrix without it was not definite.
    contacts: Vec<ContactStiffness>,
    /// Diagonal of the matrix in use and of its stiffness part, one a dof \[N/m\], without what was added to make it
    /// definite: round-off does not grow with that.
    diagonals: Vec<[f64; 2]>,
    /// Least that the stiffness part was in any matrix so far \[N/m\].
    softest: Vec<f64>,
    epoch: u64,
    forward: Vec<f64>,
    rhs: Vec<f64>,
    solution: Vec<f64>,
}

impl BodySystem {
    /// The bodies of a model that have unknowns; one that is driven as a whole has no system to solve.
    pub(crate) fn all(model: &Model, fixed: &[bool]) -> Result<Vec<Self>, NscdError> {
        let (offsets, neighbours) = node_adjacency(&model.solid);
        let graph = Graph {
            offsets: &offsets,
            neighbours: &neighbours,
        };
        let (dim, candidate) = (model.solid.dim(), model.candidates());
        let unknown = |n: &u32| dofs_of(*n, dim).any(|d| !fixed[d as usize]);
        let nodes = model.solid.bodies().iter().enumerate();
        nodes
            .filter(|(_, nodes)| nodes.iter().any(unknown))
            .map(|(index, nodes)| {
                let mut body = Self::new(&model.solid, graph, index, fixed, &candidate)?;
                if model.scheme.inertia == Inertia::QuasiStatic {
                    body.anchors = Anchors::of(model, nodes, fixed, &body.dofs);
                }
                Ok(body)
            })
            .collect()
    }

    /// Measures how stiff the bodies are, for the springs of those that supports do not hold.
    pub(crate) fn compare(bodies: &mut [Self], elements: &Elements<'_>, weights: Weights) {
        if bodies.iter().all(|body| body.anchors.is_empty()) {
            return;
        }
        let stiffness = bodies.iter_mut().map(|body| {
            if !body.anchors.is_measured() {
                body.assemble(elements, weights);
                let (pattern, largest) = (lower_of(&body.pattern), body.largest_diagonal());
                let shears = shears(elements.model(), body.index, &body.dofs);
                body.anchors
                    .measure(&shears, pattern, &body.values, largest);
            }
            body.anchors.own_stiffness()
        });
        let softest = stiffness.fold(f64::INFINITY, f64::min);
        bodies
            .iter_mut()
            .for_each(|body| body.anchors.compare(softest));
    }

    /// Orders and analyses the body `index`; `candidate` tells the nodes that may touch.
    fn new(
        solid: &Solid,
        graph: Graph<'_>,
        index: usize,
        fixed: &[bool],
        candidate: &[bool],
    ) -> Result<Self, NscdError> {
        let dim = solid.dim();
        let free_dofs = |nodes: &[u32]| -> Vec<u32> {
            let all = nodes.iter().flat_map(|n| dofs_of(*n, dim));
            all.filter(|d| !fixed[*d as usize]).collect()
        };
        let free = |n: &&u32| dofs_of(**n, dim).any(|d| !fixed[d as usize]);
        let nodes = solid.bodies()[index].iter().filter(free);
        let (last, interior): (Vec<u32>, Vec<u32>) = nodes.partition(|n| candidate[**n as usize]);
        let order = elimination_order(graph, &interior, &last);
        let first_candidate = free_dofs(&order[..interior.len()]).len();
        let dofs = free_dofs(&order);
        let n = dofs.len();
        let pattern = SymmetricPattern::new(solid, &equations(&dofs, solid.dof_count()), n)?;
        Ok(Self {
            index,
            dim,
            anchors: Anchors::default(),
            factor: Factor::new(lower_of(&pattern))?,
            values: vec![0.0; pattern.row_indices().len()],
            dofs,
            pattern,
            first_candidate,
            condensed: None,
            surface: None,
            factored: None,
            contraction: None,
            contacts: Vec::new(),
            diagonals: vec![[0.0; 2]; n],
            softest: vec![f64::INFINITY; n],
            epoch: 0,
            forward: vec![0.0; n],
            rhs: vec![0.0; n],
            solution: vec![0.0; n],
        })
    }

    /// Springs that hold the body while it is corrected, where supports do not.
    pub(crate) fn anchors(&self) -> &Anchors {
        &self.anchors
    }

    /// Contraction of the residual per iteration that the factor in use was last seen to give.
    pub(crate) fn contraction(&self) -> Option<f64> {
        self.contraction
    }

    /// Remembers an observed contraction.
    pub(crate) fn learn_contraction(&mut self, rate: f64) {
        self.contraction = rate.is_finite().then_some(rate);
    }

    /// Compliance of the candidate surface, if it was asked for since the last factorization.
    pub(crate) fn condensed(&self) -> Option<&CompliancePart> {
        self.condensed.as_ref()
    }

    /// How often the body was factorized.
    pub(crate) fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Whether the body has unknowns that may come into contact.
    pub(crate) fn has_candidates(&self) -> bool {
        self.first_candidate < self.dofs.len()
    }

    /// Whether the factor in use belongs to these weights.
    pub(crate) fn is_factored_for(&self, weights: Weights) -> bool {
        self.factored == Some(weights)
    }

    /// Estimated seconds of a factorization with condensation.
    pub(crate) fn factor_cost(&self) -> f64 {
        let candidates = self.dofs.len() - self.first_candidate;
        COSTS.factorization(self.factor.flops, candidates, self.values.len())
    }

    /// Estimated seconds of one forward and backward substitution.
    pub(crate) fn solve_cost(&self) -> f64 {
        COSTS.substitution(self.factor.fill(), self.values.len())
    }

    /// Least stiffness part of each diagonal entry so far \[N/m\], infinite before the first factorization.
    pub(crate) fn softest(&self) -> &[f64] {
        &self.softest
    }

    /// Diagonal of the matrix in use and of its stiffness part, one a dof \[N/m\].
    pub(crate) fn diagonals(&self) -> &[[f64; 2]] {
        &self.diagonals
    }

    /// Largest diagonal entry of the matrix in use \[N/m\].
    pub(crate) fn largest_diagonal(&self) -> f64 {
        self.diagonals
            .iter()
            .fold(0.0, |m, [whole, _]| m.max(*whole))
    }

    /// Assembles and factorizes `stiffness K + damping A + mass M`. An indefinite matrix is made definite by the
    /// stiffness of `contacts`, those of other bodies are ignored, and if that does not suffice by adding to its
    /// diagonal, as little as needed in powers of ten. It is counted.
    pub(crate) fn refactor(
        &mut self,
        elements: &Elements<'_>,
        weights: Weights,
        contacts: &[ContactStiffness],
        counters: &mut Counters,
    ) -> Result<(), StepFailure> {
        self.factored = None;
        self.epoch += 1;
        self.contraction = None;
        self.condensed = None;
        self.surface = None;
        self.assemble(elements, weights);
        if !self.anchors.is_empty() {
            self.anchors
                .enter(lower_of(&self.pattern), &mut self.values);
        }
        self.factorize_shifted(contacts, counters)?;
        self.factored = Some(weights);
        Ok(())
    }

    fn assemble(&mut self, elements: &Elements<'_>, weights: Weights) {
        let model = elements.model();
        self.pattern
            .gather_tangent(elements.tangents(), weights.stiffness, &mut self.values);
        let elastic = lower_of(&self.pattern).diagonal(&self.values);
        if let Some((initial, factor)) = elements.damping_stiffness() {
            let mut damping = vec![0.0; self.values.len()];
            self.pattern
                .gather_tangent(initial, weights.damping * factor, &mut damping);
            let entries = self.values.iter_mut().zip(&damping);
            entries.for_each(|(a, d)| *a += d);
        }
        let mass = weights.mass + weights.damping * model.damping.mass;
        if mass != 0.0 {
            self.pattern.add_mass(&model.mass, mass, &mut self.values);
        }
        for (softest, now) in self.softest.iter_mut().zip(&elastic) {
            *softest = softest.min(now.abs());
        }
        let both = lower_of(&self.pattern)
            .diagonal(&self.values)
            .into_iter()
            .zip(elastic);
        self.diagonals = both.map(|(whole, elastic)| [whole, elastic]).collect();
    }

    /// Adds a part of the largest diagonal entry to the whole diagonal. The residual stays exact, so a body that
    /// contacts hold goes to its equilibrium in a few short steps more.
    fn stiffen(&mut self, part: f64) {
        let shift = part * self.largest_diagonal();
        for k in 0..self.dofs.len() {
            self.values[self.pattern.column_pointers()[k]] += shift;
        }
    }

    /// Adds a part of each diagonal entry to itself: in a graded mesh, the more so around an axis, the largest is no
    /// measure for the others.
    fn stiffen_each(&mut self, part: f64) {
        let least = f64::EPSILON * self.largest_diagonal();
        for k in 0..self.dofs.len() {
            let own = self.diagonals[k][0].abs().max(least);
            self.values[self.pattern.column_pointers()[k]] += part * own;
        }
    }

    /// Stiffness of contacts in the factor in use.
    pub(crate) fn contact_stiffness(&self) -> &[ContactStiffness] {
        &self.contacts
    }

    fn factorize_shifted(
        &mut self,
        contacts: &[ContactStiffness],
        counters: &mut Counters,
    ) -> Result<(), StepFailure> {
        self.contacts.clear();
        let Err(_) = self.factorize(counters) else {
            return Ok(());
        };
        counters.indefinite_tangents += 1;
        if !contacts.is_empty() {
            let pattern = lower_of(&self.pattern);
            let diagonal = |e: usize| self.diagonals[e][0];
            self.contacts = augment(
                contacts,
                self.dim,
                &self.dofs,
                diagonal,
                pattern,
                &mut self.values,
            );
            if self.factorize(counters).is_ok() {
                return Ok(());
            }
        }
        if self.stiffen_anchors(counters) {
            return Ok(());
        }
        let mut shift = FIRST_SHIFT;
        loop {
            // Under a contact small elements buckle first, and what the largest one needs would stall them.
            if contacts.is_empty() {
                self.stiffen(shift);
            } else {
                self.stiffen_each(shift);
            }
            let Err(bad) = self.factorize(counters) else {
                return Ok(());
            };
            if shift > LAST_SHIFT {
                let node = self.dofs[bad.equation] as usize / self.dim;
                return Err(StepFailure::Indefinite {
                    body: self.index,
                    node,
                });
            }
            shift *= NEXT_SHIFT;
        }
    }

    /// Whether stiffer springs make the matrix definite.
    fn stiffen_anchors(&mut self, counters: &mut Counters) -> bool {
        let mut attempt = 0;
        loop {
            let pattern = lower_of(&self.pattern);
            if !self.anchors.stiffen(attempt, pattern, &mut self.values) {
                return false;
            }
            if self.factorize(counters).is_ok() {
                return true;
            }
            attempt += 1;
        }
    }

    fn factorize(&mut self, counters: &mut Counters) -> Result<(), Indefinite> {
        counters.factorizations += 1;
        self.factor.factorize(lower_of(&self.pattern), &self.values)
    }

    /// The compliance of the candidate surface, from the trailing block of the factor.
    pub(crate) fn condense(
        &mut self,
        total_dofs: usize,
        counters: &mut Counters,
    ) -> Result<(), StepFailure> {
        if self.condensed.is_some() {
            return Ok(());
        }
        counters.condensations += 1;
        let (surface, c) = self.factor.condense(self.first_candidate);
        let mut offset = vec![u32::MAX; total_dofs];
        for (k, &d) in self.dofs[self.first_candidate..].iter().enumerate() {
            offset[d as usize] = k as u32;
        }
        self.surface = Some(surface);
        self.condensed = Some(CompliancePart::new(offset, c)?);
        self.move_anchors(total_dofs);
        Ok(())
    }

    /// Finds what a unit force on each spring moves.
    fn move_anchors(&mut self, total_dofs: usize) {
        let mut motions = Vec::new();
        for &spring in self.anchors.equations() {
            let mut x = vec![0.0; self.dofs.len()];
            x[spring] = 1.0;
            self.factor.forward(&mut x);
            self.factor.backward(&mut x);
            let mut motion = vec![0.0; total_dofs];
            for (x, &d) in x.iter().zip(&self.dofs) {
                motion[d as usize] = *x;
            }
            motions.push(motion);
        }
        self.anchors.set_motions(motions);
    }

    /// First half of a solve: `y = L^-1 b` for the residual `b` (global).
    pub(crate) fn forward(&mut self, b: &[f64]) {
        for (k, &d) in self.dofs.iter().enumerate() {
            self.rhs[k] = b[d as usize];
        }
        self.forward.copy_from_slice(&self.rhs);
        self.factor.forward(&mut self.forward);
    }

    /// Correction of the candidate dofs that the residual alone would give, into global `z`.
    pub(crate) fn free_surface(&mut self, z: &mut [f64]) {
        let Some(surface) = &self.surface else { return };
        let first = self.first_candidate;
        surface.free_solution(&self.forward[first..], &mut self.solution[first..]);
        for (k, &d) in self.dofs.iter().enumerate().skip(first) {
            z[d as usize] = self.solution[k];
        }
    }

    /// Second half: adds the contact force `f = H^T r` (global), substitutes back and writes the
    /// correction into global `z`. The residual of the solve is recomputed and refined if needed.
    pub(crate) fn backward(
        &mut self,
        f: Option<&[f64]>,
        z: &mut [f64],
        counters: &mut Counters,
    ) -> Result<(), StepFailure> {
        let first = self.first_candidate;
        let mut scale = norm(&self.rhs);
        if let (Some(f), Some(surface)) = (f, &self.surface) {
            let on_surface: Vec<f64> = self.dofs[first..].iter().map(|&d| f[d as usize]).collect();
            surface.add_force(&on_surface, &mut self.forward[first..]);
            self.rhs[first..]
                .iter_mut()
                .zip(&on_surface)
                .for_each(|(b, f)| *b += f);
            scale += norm(&on_surface);
        }
        self.solution.copy_from_slice(&self.forward);
        self.factor.backward(&mut self.solution);
        counters.linear_solves += 1;
        self.check_solution(scale, counters)?;
        for (k, &d) in self.dofs.iter().enumerate() {
            z[d as usize] = self.solution[k];
        }
        Ok(())
    }

    /// `scale` is the size of the forces whose balance the right hand side is.
    fn check_solution(&mut self, scale: f64, counters: &mut Counters) -> Result<(), StepFailure> {
        if scale == 0.0 {
            return Ok(());
        }
        let lower = lower_of(&self.pattern);
        let mut worst = f64::INFINITY;
        for attempt in 1..=SOLVES {
            let mut left = self.rhs.clone();
            lower.subtract_product(&self.values, &self.solution, &mut left);
            let residual = norm(&left) / scale;
            if residual <= GOOD_SOLVE || (attempt == SOLVES && residual <= LAST_SOLVE) {
                return Ok(());
            }
            worst = residual;
            if !residual.is_finite() {
                break;
            }
            counters.refinements += 1;
            self.factor.forward(&mut left);
            self.factor.backward(&mut left);
            self.solution
                .iter_mut()
                .zip(&left)
                .for_each(|(x, dx)| *x += dx);
        }
        Err(StepFailure::Linear {
            body: self.index,
            residual: worst,
        })
    }
}

/// The dofs of a node.
fn dofs_of(node: u32, dim: usize) -> impl Iterator<Item = u32> {
    (0..dim as u32).map(move |c| dim as u32 * node + c)
}

fn lower_of(pattern: &SymmetricPattern) -> LowerPattern<'_> {
    LowerPattern {
        pointers: pattern.column_pointers(),
        rows: pattern.row_indices(),
    }
}

#[cfg(test)]
mod tests;
