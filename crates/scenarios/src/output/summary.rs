//! `summary.json`.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::{Folder, OutputError};
use crate::energies::Energies;
use crate::spec::Extent;

/// How the run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The end was reached, every accepted step converged, and the energies speak for the run.
    Completed,
    /// The end was reached, but the energies speak against the run; [`Summary::reason`] says how.
    Unreliable,
    /// The run goes on, or was broken off: [`Summary::time`] and [`Summary::steps`] say how far it had come.
    Running,
    /// Stopped before the end; [`Summary::reason`] says why. What was computed stays.
    #[default]
    Stopped,
}

impl Status {
    /// In words, as in the files.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Status::Completed => "completed",
            Status::Unreliable => "unreliable",
            Status::Running => "running",
            Status::Stopped => "stopped",
        }
    }
}

/// Units of a run whose scene is in SI units.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Units {
    /// Of forces: `N`, in plane strain `N/m`.
    pub force: String,
    /// Of energies, works and dissipations: `J`, in plane strain `J/m`.
    pub energy: String,
    /// Of moments: `N m`, in plane strain `N m/m`.
    pub moment: String,
}

impl Units {
    /// Those of a scene of this extent.
    #[must_use]
    pub fn of(extent: Extent) -> Units {
        let unit = |solid: &str| {
            let label = extent.label(&format!("[{solid}]"));
            label.trim_matches(['[', ']']).to_owned()
        };
        Units {
            force: unit("N"),
            energy: unit("J"),
            moment: unit("N m"),
        }
    }
}

impl Default for Units {
    fn default() -> Self {
        Units::of(Extent::default())
    }
}

/// What a run did and cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Summary {
    /// How it ended.
    pub status: Status,
    /// Why it stopped (step, time, contact, element, residual) or is not to be believed; null when completed.
    pub reason: Option<String>,
    /// Time reached \[s\].
    pub time: f64,
    /// Accepted steps \[-\].
    pub steps: usize,
    /// Rejected steps \[-\].
    pub rejected_steps: usize,
    /// Newton iterations of all steps \[-\].
    pub newton_iterations: usize,
    /// Numeric factorizations \[-\].
    pub factorizations: usize,
    /// Contact problems solved \[-\].
    pub contact_solves: usize,
    /// Iterations of all contact solves \[-\].
    pub contact_iterations: usize,
    /// Unknowns \[-\].
    pub dofs: usize,
    /// Elements \[-\].
    pub elements: usize,
    /// Most contacts in a step \[-\].
    pub contacts_max: usize,
    /// Contact problems that held bonds \[-\].
    pub bonded_solves: u64,
    /// CPU time of all threads \[s\].
    pub cpu_s: f64,
    /// Wall time \[s\].
    pub wall_s: f64,
    /// Wall time by phase \[s\].
    pub phases: IndexMap<String, f64>,
    /// Tangents that were not positive definite and were shifted \[-\].
    pub indefinite_tangents: usize,
    /// Largest residual force over the largest force in play in an accepted step \[-\].
    pub max_residual: f64,
    /// Why steps were rejected, with their times, at most the first hundred.
    pub rejections: Vec<String>,
    /// What a reader of the results should know.
    pub warnings: Vec<String>,
    /// Energy audit.
    pub energy: EnergySummary,
    /// Units of forces, energies and moments.
    #[serde(default)]
    pub units: Units,
    /// Deepest penetration at the end of an accepted step, and of slave nodes without contact at the end of the run
    /// \[m\].
    pub max_penetration: f64,
    /// Largest relative error of the contact law in an accepted step \[-\].
    pub max_contact_error: f64,
}

/// Energy audit of a run \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct EnergySummary {
    /// Kinetic, strain and adhesive energy at the start \[J\].
    pub initial: f64,
    /// The same at the end \[J\].
    #[serde(rename = "final")]
    pub end: f64,
    /// The terms at the end.
    #[serde(flatten)]
    pub terms: Energies,
}

impl EnergySummary {
    /// From the total energy at the start \[J\] and the energies at the end.
    #[must_use]
    pub fn new(initial: f64, end: &Energies) -> EnergySummary {
        EnergySummary {
            initial,
            end: end.stored(),
            terms: *end,
        }
    }

    /// What the listed terms leave unexplained \[J\]: end - initial - work + dissipations + integration error. Each
    /// term has its own formula, so zero proves something.
    #[must_use]
    pub fn unexplained(&self) -> f64 {
        self.end - self.initial - self.terms.load_work + self.terms.lost()
    }
}

impl Summary {
    /// Writes `summary.json` in one move.
    ///
    /// # Errors
    /// [`OutputError::File`].
    pub fn write(&self, folder: &Folder) -> Result<(), OutputError> {
        let mut text = serde_json::to_vec_pretty(self).map_err(|source| OutputError::File {
            path: folder.file("summary.json"),
            source: source.into(),
        })?;
        text.push(b'\n');
        folder.write("summary.json", &text)
    }
}
