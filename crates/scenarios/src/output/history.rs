//! Rows of `history.csv`.

use std::io;
use std::path::Path;

use super::OutputError;
use crate::energies::Energies;
use crate::spec::Layout;

/// Resultant on an interface or a driven boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force {
    /// Force \[N\].
    pub force: [f64; 3],
    /// Moment \[N m\].
    pub moment: [f64; 3],
}

/// Bonds of an interface with adhesion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bonds {
    /// Largest intensity \[-\].
    pub largest: f64,
    /// Mean intensity over the slave surface \[-\].
    pub mean: f64,
    /// Slave nodes whose intensity is above the threshold of their interface.
    pub bonded: usize,
}

/// One accepted step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Time \[s\].
    pub time: f64,
    /// Energies \[J\].
    pub energies: Energies,
    /// Closed contacts.
    pub contacts: usize,
    /// Deepest penetration \[m\].
    pub penetration: f64,
    /// Error of the contact law relative to the largest contact force \[-\].
    pub contact_error: f64,
    /// One per name of the [`Layout`].
    pub forces: Vec<Force>,
    /// One per bonded interface of the [`Layout`].
    pub bonds: Vec<Bonds>,
    /// Probe values, probe after probe, quantity after quantity, component after component.
    pub probes: Vec<f64>,
}

impl Row {
    /// Numbers in the order of the header of `layout`. A row with too few forces, bonds or probe values is filled with
    /// NaN, one with too many cut.
    #[must_use]
    pub fn numbers(&self, layout: &Layout) -> Vec<f64> {
        let mut numbers = vec![self.time];
        numbers.extend(self.energies.values());
        numbers.extend([self.contacts as f64, self.penetration, self.contact_error]);
        let unknown = Force {
            force: [f64::NAN; 3],
            moment: [f64::NAN; 3],
        };
        for i in 0..layout.forces.len() {
            let Force { force, moment } = self.forces.get(i).copied().unwrap_or(unknown);
            numbers.extend(force);
            numbers.extend(moment);
        }
        for i in 0..layout.bonds.len() {
            let bonds = self.bonds.get(i);
            let bonds = bonds.map(|b| [b.largest, b.mean, b.bonded as f64]);
            numbers.extend(bonds.unwrap_or([f64::NAN; 3]));
        }
        let probe = |i| self.probes.get(i).copied().unwrap_or(f64::NAN);
        numbers.extend((0..layout.probe_columns()).map(probe));
        numbers
    }
}

/// All rows of a run, column-wise readable for plots.
#[derive(Clone, Debug, Default)]
pub struct History {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl History {
    /// No rows yet.
    #[must_use]
    pub fn new(header: Vec<String>) -> History {
        History {
            header,
            rows: Vec::new(),
        }
    }

    /// Reads a `history.csv`.
    ///
    /// # Errors
    /// [`OutputError::Unread`] for a file that cannot be read or holds something else than numbers.
    pub fn read(path: &Path) -> Result<History, OutputError> {
        let read = || -> io::Result<History> {
            let mut reader = csv::Reader::from_path(path)?;
            let mut history = History::new(reader.headers()?.iter().map(str::to_owned).collect());
            for record in reader.records() {
                let record = record?;
                let numbers = record.iter().map(str::parse::<f64>);
                let numbers: Result<Vec<f64>, _> = numbers.collect();
                history.push(numbers.map_err(io::Error::other)?);
            }
            Ok(history)
        };
        read().map_err(|source| OutputError::Unread {
            path: path.to_owned(),
            source,
        })
    }

    /// Adds the numbers of a row.
    pub fn push(&mut self, numbers: Vec<f64>) {
        self.rows.push(numbers);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Names of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Values of a column over the rows.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.header.iter().position(|column| column == name)?;
        Some(
            self.rows
                .iter()
                .filter_map(|row| row.get(index).copied())
                .collect(),
        )
    }
}
