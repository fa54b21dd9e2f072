//! What a run tells about itself: counters, phases, energies, forces.

use nalgebra::Vector3;

use crate::error::StepFailure;

/// Work done, for proving what was skipped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counters {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected_steps: u64,
    /// Corrections of the displacement.
    pub newton_iterations: u64,
    /// Evaluations of the internal force alone.
    pub force_evaluations: u64,
    /// Evaluations of the element tangents.
    pub tangent_evaluations: u64,
    /// Numeric factorizations, one a body.
    pub factorizations: u64,
    /// Tangents that were not positive definite and were shifted.
    pub indefinite_tangents: u64,
    /// Condensations of a body onto its contact surface.
    pub condensations: u64,
    /// Forward and backward substitutions, one a body.
    pub linear_solves: u64,
    /// Iterative refinements of a linear solve.
    pub refinements: u64,
    /// Contact detections.
    pub detections: u64,
    /// Contact problems solved.
    pub contact_solves: u64,
    /// Iterations of the contact solver.
    pub contact_iterations: u64,
    /// Largest number of contacts in one contact problem.
    pub contacts_max: u64,
    /// Contact problems that held bonds.
    pub bonded_solves: u64,
    /// Bonds that held when the contact search lost their pair.
    pub lost_bonds: u64,
    /// Accepted steps whose error of the contact law lies above the tolerance, at the round-off of gaps and forces.
    pub stagnant_steps: u64,
}

/// Part of the work that a time is booked on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Phase {
    /// Element forces and tangents.
    Elements,
    /// Gathering and factorizing matrices.
    Factorization,
    /// Compliance of the contact surfaces and the operator W.
    Condensation,
    /// Forward and backward substitutions.
    Substitution,
    /// Contact search.
    Detection,
    /// Contact solve.
    Contact,
}

impl Phase {
    /// All phases in the order of [`Phases`].
    pub const ALL: [(Phase, &'static str); 6] = [
        (Phase::Elements, "elements"),
        (Phase::Factorization, "factorization"),
        (Phase::Condensation, "condensation"),
        (Phase::Substitution, "substitution"),
        (Phase::Detection, "detection"),
        (Phase::Contact, "contact"),
    ];
}

/// Seconds spent in each phase, indexed like [`Phase::ALL`].
pub type Phases = [f64; Phase::ALL.len()];

/// Reads a clock; the libraries themselves know no time.
pub trait Clock {
    /// Seconds since any fixed moment.
    fn seconds(&self) -> f64;
}

/// A clock that stands still: for tests and for callers that need no times.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoClock;

impl Clock for NoClock {
    fn seconds(&self) -> f64 {
        0.0
    }
}

/// Energy terms of one step or summed over a run \[J\]. Each is computed from its own formula, none
/// as the remainder of the others, so that [`EnergyTerms::imbalance`] proves something.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct EnergyTerms {
    /// Change of the kinetic energy `(v1 . M v1 - v0 . M v0)/2` \[J\].
    pub kinetic: f64,
    /// Change of the strain energy \[J\].
    pub strain: f64,
    /// Change of the adhesive energy of the bonds \[J\].
    pub adhesive: f64,
    /// Work of loads, supports and moving obstacles \[J\].
    pub load_work: f64,
    /// Dissipation of friction, `-r_t . dx_t` \[J\].
    pub friction: f64,
    /// Dissipation of breaking and healing bonds \[J\].
    pub bond: f64,
    /// Dissipation of damping \[J\].
    pub damping: f64,
    /// Loss of closing contacts, `r_n (g_0 - g_1)`, or `-r_n dx_n` at the velocity level \[J\].
    pub impact: f64,
    /// Loss by the integration of the bulk, `du . (F_int used) - dW` \[J\].
    pub bulk_error: f64,
    /// Loss by the time scheme, `(du/dt - (v0+v1)/2) . M (v1-v0)`, that is `(theta-1/2) |dv|_M^2` \[J\].
    pub scheme_error: f64,
    /// Loss because gaps are curved: `-r_n (n . dX - (g_1 - g_0))` \[J\].
    pub gap_error: f64,
    /// Loss by the integration of the bonds: their work minus what they store and dissipate \[J\].
    pub bond_error: f64,
}

impl EnergyTerms {
    /// All that the discretisation loses (positive) or gains (negative) \[J\].
    #[must_use]
    pub fn integration_error(&self) -> f64 {
        self.bulk_error + self.scheme_error + self.gap_error + self.bond_error
    }

    /// What the balance leaves open \[J\]: zero but for the tolerance of Newton's iteration.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        let stored = self.kinetic + self.strain + self.adhesive;
        let lost =
            self.friction + self.bond + self.damping + self.impact + self.integration_error();
        stored + lost - self.load_work
    }

    /// Adds the terms of another step.
    pub(crate) fn add(&mut self, other: &Self) {
        let terms = self.terms_mut().into_iter().zip(other.named());
        terms.for_each(|(sum, (_, term))| *sum += term);
    }

    /// All terms with their names, in the order of the balance: what is stored, the work that came in, what is lost,
    /// and the errors of the integration.
    #[must_use]
    pub fn named(&self) -> [(&'static str, f64); 12] {
        [
            ("kinetic", self.kinetic),
            ("strain", self.strain),
            ("adhesive", self.adhesive),
            ("load_work", self.load_work),
            ("friction", self.friction),
            ("bond", self.bond),
            ("damping", self.damping),
            ("impact", self.impact),
            ("bulk_error", self.bulk_error),
            ("scheme_error", self.scheme_error),
            ("gap_error", self.gap_error),
            ("bond_error", self.bond_error),
        ]
    }

    /// In the order of [`Self::named`].
    fn terms_mut(&mut self) -> [&mut f64; 12] {
        [
            &mut self.kinetic,
            &mut self.strain,
            &mut self.adhesive,
            &mut self.load_work,
            &mut self.friction,
            &mut self.bond,
            &mut self.damping,
            &mut self.impact,
            &mut self.bulk_error,
            &mut self.scheme_error,
            &mut self.gap_error,
            &mut self.bond_error,
        ]
    }
}

/// Force and moment about the origin that act on the bodies.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Resultant {
    /// Force \[N\].
    pub force: Vector3<f64>,
    /// Moment about the origin at the end positions \[N m\].
    pub moment: Vector3<f64>,
}

impl Resultant {
    /// Adds the force `f` \[N\] at the place `at` \[m\].
    pub(crate) fn add(&mut self, f: Vector3<f64>, at: Vector3<f64>) {
        self.force += f;
        self.moment += at.cross(&f);
    }
}

/// Slave nodes that no contact holds, inside the bodies of their masters.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Overlap {
    /// How many there are.
    pub nodes: usize,
    /// The deepest of them.
    pub node: u32,
    /// Its interface.
    pub interface: usize,
    /// Its distance to the boundary of the master's body \[m\].
    pub depth: f64,
}

/// One accepted step.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// End of the step \[s\].
    pub time: f64,
    /// Length of the step \[s\].
    pub dt: f64,
    /// Corrections made.
    pub newton_iterations: usize,
    /// Residual force over the largest force in play, recomputed at the end state \[-\].
    pub residual: f64,
    /// Error of the contact law relative to the largest contact force, recomputed at the end state \[-\].
    pub contact_error: f64,
    /// Contacts with a force or a closed gap.
    pub contacts_closed: usize,
    /// Deepest penetration \[m\].
    pub penetration: f64,
    /// Energy terms of the step.
    pub energy: EnergyTerms,
    /// Forces of the interfaces on their slave bodies, in the order of the model.
    pub interfaces: Vec<Resultant>,
    /// Forces of the supports on the bodies, in the order of the model.
    pub supports: Vec<Resultant>,
}

/// A rejected step.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Rejection {
    /// Start of the step \[s\].
    pub time: f64,
    /// Its length \[s\].
    pub dt: f64,
    /// Why it was rejected.
    pub reason: StepFailure,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_sums_follow_the_same_order() {
        let mut terms = EnergyTerms::default();
        let places = terms.terms_mut().into_iter();
        places.zip(1..).for_each(|(term, k)| *term = f64::from(k));
        let mut twice = terms;
        twice.add(&terms);
        for (k, ((name, once), (_, both))) in
            terms.named().into_iter().zip(twice.named()).enumerate()
        {
            assert_eq!(
                (once, both),
                (1.0 + k as f64, 2.0 + 2.0 * k as f64),
                "{name}"
            );
        }
    }
}
