//! What the energies of a run went through: extremes that the sums at its end no longer tell.

use crate::flat::largest;
use crate::model::Model;
use crate::report::EnergyTerms;
use crate::state::State;

/// Strain of all bodies whose forces and energy count as none \[-\]: round-off of strains, 1e-16 of numbers of size one
/// and of displacements that are some hundred elements long, with room.
const NO_STRAIN: f64 = 1e-13;
/// Strain at which they are measured \[-\]: so small that any law is linear, so large that its energy is no round-off.
const TRIAL_STRAIN: f64 = 1e-4;

/// Extremes of the energies over the accepted steps.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct EnergyAudit {
    /// The most that was in play \[J\]: stored (without signs), done by loads, dissipated.
    pub in_play: f64,
    /// Energy that counts as none \[J\]: that of all bodies at a strain of round-off, and what the forces of that
    /// strain do along the way of the bodies.
    pub nothing: f64,
    /// The most that the balance of all steps so far left open \[J\]; infinite where a term is not a number.
    pub open: f64,
    /// The most that the integration made \[J\]: the deepest fall of its loss from what it was before.
    pub made: f64,
    /// The most that came back from friction \[J\]: the deepest fall of its dissipation, which should never fall.
    pub friction_made: f64,
    /// The same of bonds \[J\].
    pub bonds_made: f64,
    /// The same of damping \[J\].
    pub damping_made: f64,
    /// The same of closing contacts \[J\].
    pub impact_made: f64,
    /// Forces at a strain of round-off, the sum of their sizes \[N\].
    no_force: f64,
    /// Highest loss by the integration, and highest dissipations in the order of the fields above \[J\].
    highest: [f64; 5],
}

impl EnergyAudit {
    /// For a run of a model that starts with the stored energy `initial` \[J\].
    pub(crate) fn new(model: &Model, initial: f64) -> Self {
        let (nothing, no_force) = of_round_off(model);
        Self {
            in_play: initial.abs(),
            nothing,
            no_force,
            ..Self::default()
        }
    }

    /// Follows the energies to the end of an accepted step; `sums` are those of all steps so far.
    pub(crate) fn follow(&mut self, state: &State, sums: &EnergyTerms) {
        let stored = state.kinetic_energy + state.strain_energy.abs() + state.adhesive_energy.abs();
        let dissipated = [sums.friction, sums.bond, sums.damping, sums.impact];
        let sizes = dissipated.iter().map(|d| d.abs());
        let largest_term = sizes.fold(stored.max(sums.load_work.abs()), f64::max);
        self.in_play = self.in_play.max(largest_term);
        self.nothing = self.nothing.max(self.no_force * largest(&state.u));
        let open = sums.imbalance().abs();
        self.open = self
            .open
            .max(if open.is_nan() { f64::INFINITY } else { open });
        let made = [
            &mut self.made,
            &mut self.friction_made,
            &mut self.bonds_made,
            &mut self.damping_made,
            &mut self.impact_made,
        ];
        let lost = std::iter::once(sums.integration_error()).chain(dissipated);
        for ((made, highest), lost) in made.into_iter().zip(&mut self.highest).zip(lost) {
            *highest = highest.max(lost);
            *made = made.max(*highest - lost);
        }
    }

    /// Part of the energy in play \[-\]; zero where `energy` \[J\] is none.
    #[must_use]
    pub fn share(&self, energy: f64) -> f64 {
        match energy {
            none if none.abs() <= self.nothing => 0.0,
            endless if !endless.is_finite() => f64::INFINITY,
            some => some.abs() / self.in_play.max(self.nothing),
        }
    }
}

/// Energy \[J\] and sum of the forces \[N\] of all bodies at a strain of round-off, from those of a small uniform
/// stretch.
fn of_round_off(model: &Model) -> (f64, f64) {
    let positions = model.positions(&vec![0.0; model.dof_count()]);
    let stretch: Vec<f64> = positions.iter().map(|x| TRIAL_STRAIN * x).collect();
    let mut force = vec![0.0; stretch.len()];
    let mut workspace = model.solid.workspace();
    let energy = model
        .solid
        .internal_force(&stretch, &mut workspace, &mut force);
    let ratio = NO_STRAIN / TRIAL_STRAIN;
    let forces: f64 = force.iter().map(|f| f.abs()).sum();
    match energy {
        Ok(energy) => (energy.abs() * ratio.powi(2), forces * ratio),
        // No element turns inside out by that; if one did, no energy would count as none.
        Err(_) => (0.0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn audit() -> EnergyAudit {
        EnergyAudit {
            in_play: 10.0,
            nothing: 1e-9,
            ..EnergyAudit::default()
        }
    }

    fn state(kinetic_energy: f64) -> State {
        State {
            time: 0.0,
            u: Vec::new(),
            v: Vec::new(),
            internal_force: Vec::new(),
            external_force: Vec::new(),
            strain_energy: 0.0,
            kinetic_energy,
            support_force: Vec::new(),
            contact_force: Vec::new(),
            contacts: Vec::new(),
            bonds: Vec::new(),
            adhesive_energy: 0.0,
            last_dt: None,
            u_before: Vec::new(),
        }
    }

    #[test]
    fn what_comes_back_stays_told_when_the_sums_recover() {
        let mut audit = audit();
        let mut follow = |friction: f64, scheme_error: f64| {
            let sums = EnergyTerms {
                friction,
                scheme_error,
                kinetic: -friction - scheme_error,
                ..EnergyTerms::default()
            };
            audit.follow(&state(10.0), &sums);
        };
        follow(2.0, 1.0);
        follow(1.5, -1.0);
        follow(4.0, 3.0);
        assert_eq!((audit.friction_made, audit.made), (0.5, 2.0));
        assert_eq!((audit.open, audit.in_play), (0.0, 10.0));
        assert_eq!(audit.share(audit.made), 0.2);
    }

    #[test]
    fn round_off_is_no_share_and_what_is_no_number_is_all_of_it() {
        let mut audit = audit();
        assert_eq!(audit.share(1e-10), 0.0);
        let sums = EnergyTerms {
            damping: f64::NAN,
            ..EnergyTerms::default()
        };
        audit.follow(&state(1.0), &sums);
        assert_eq!(audit.share(audit.open), f64::INFINITY);
    }
}
