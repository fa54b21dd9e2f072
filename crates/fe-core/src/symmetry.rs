//! What a plane problem stands for.

/// What is the same all along a direction that the mesh does not have.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Symmetry {
    /// The mesh has all three directions.
    #[default]
    None,
    /// No displacement along z, nothing changes with z: forces \[N/m\], masses \[kg/m\] and energies \[J/m\] are
    /// those of one metre of thickness.
    PlaneStrain,
    /// Nothing changes around the y axis, no torsion: x is the radius, never negative. Forces, masses, areas and
    /// energies are those of the whole ring. Nodes on the axis must be held in x.
    Axisymmetric,
}

impl Symmetry {
    /// Unknowns per node, 2 or 3.
    pub const fn dim(self) -> usize {
        match self {
            Symmetry::None => 3,
            Symmetry::PlaneStrain | Symmetry::Axisymmetric => 2,
        }
    }

    /// What a unit of the mesh stands for at the coordinate `x` \[m\]: the circumference `2 pi x` of a ring, else one.
    pub(crate) fn extent(self, x: f64) -> f64 {
        match self {
            Symmetry::Axisymmetric => std::f64::consts::TAU * x,
            Symmetry::None | Symmetry::PlaneStrain => 1.0,
        }
    }
}
