//! The energies of a run: one list for `history.csv`, `summary.json`, `sweep.csv`, pictures and the closing table.

use serde::{Deserialize, Serialize};

/// Energies at a time; works, dissipations and errors are sums since the start \[J\]. In `summary.json` under these
/// names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Kinetic energy \[J\].
    pub kinetic: f64,
    /// Strain energy \[J\].
    pub strain: f64,
    /// Energy of the adhesive bonds \[J\].
    pub adhesive: f64,
    /// Work done on the bodies by loads and prescribed motions \[J\].
    pub load_work: f64,
    /// Dissipated by friction \[J\].
    pub friction_dissipation: f64,
    /// Dissipated by bonds that break or heal \[J\].
    pub bond_dissipation: f64,
    /// Dissipated by damping \[J\].
    pub damping_dissipation: f64,
    /// Lost by contacts that close \[J\].
    pub impact_loss: f64,
    /// Energy that the time integration loses (positive) or gains (negative) \[J\].
    pub integration_error: f64,
}

/// One of the [`Energies`]: its names and where it is.
#[derive(Clone, Copy, Debug)]
pub struct EnergyTerm {
    /// Column of `history.csv` and `sweep.csv`; `energy.` stands before what is stored.
    pub column: &'static str,
    /// Words of the closing table.
    pub words: &'static str,
    /// Its value \[J\].
    pub value: fn(&Energies) -> f64,
}

impl EnergyTerm {
    const fn new(
        column: &'static str,
        words: &'static str,
        value: fn(&Energies) -> f64,
    ) -> EnergyTerm {
        EnergyTerm {
            column,
            words,
            value,
        }
    }

    /// True for what the bodies and bonds hold, false for what came or went.
    pub(crate) fn is_stored(&self) -> bool {
        self.column.starts_with("energy.")
    }
}

/// All terms in the order of the files.
pub const ENERGY_TERMS: [EnergyTerm; 9] = [
    EnergyTerm::new("energy.kinetic", "- kinetic", |e| e.kinetic),
    EnergyTerm::new("energy.strain", "- strain", |e| e.strain),
    EnergyTerm::new("energy.adhesive", "- adhesive", |e| e.adhesive),
    EnergyTerm::new("work.load", "load work", |e| e.load_work),
    EnergyTerm::new("dissipation.friction", "friction dissipation", |e| {
        e.friction_dissipation
    }),
    EnergyTerm::new("dissipation.bond", "bond dissipation", |e| {
        e.bond_dissipation
    }),
    EnergyTerm::new("dissipation.damping", "damping dissipation", |e| {
        e.damping_dissipation
    }),
    EnergyTerm::new("dissipation.impact", "impact loss", |e| e.impact_loss),
    EnergyTerm::new("error.integration", "integration error", |e| {
        e.integration_error
    }),
];

impl Energies {
    /// In the order of [`ENERGY_TERMS`] \[J\].
    #[must_use]
    pub fn values(&self) -> [f64; ENERGY_TERMS.len()] {
        ENERGY_TERMS.map(|term| (term.value)(self))
    }

    /// The same with 0 for -0, the sum of nothing.
    pub(crate) fn without_negative_zeros(self) -> Energies {
        let Energies {
            kinetic,
            strain,
            adhesive,
            load_work,
            friction_dissipation,
            bond_dissipation,
            damping_dissipation,
            impact_loss,
            integration_error,
        } = self;
        Energies {
            kinetic: kinetic + 0.0,
            strain: strain + 0.0,
            adhesive: adhesive + 0.0,
            load_work: load_work + 0.0,
            friction_dissipation: friction_dissipation + 0.0,
            bond_dissipation: bond_dissipation + 0.0,
            damping_dissipation: damping_dissipation + 0.0,
            impact_loss: impact_loss + 0.0,
            integration_error: integration_error + 0.0,
        }
    }

    /// Kinetic, strain and adhesive energy together \[J\].
    #[must_use]
    pub fn stored(&self) -> f64 {
        self.kinetic + self.strain + self.adhesive
    }

    /// Dissipated, lost by impacts and by the time integration together \[J\].
    #[must_use]
    pub fn lost(&self) -> f64 {
        self.friction_dissipation
            + self.bond_dissipation
            + self.damping_dissipation
            + self.impact_loss
            + self.integration_error
    }
}
