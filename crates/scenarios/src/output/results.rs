//! All results of a run, written as it goes.

use std::path::Path;

use contact_bipotential::ContactProblem;

use super::{
    Folder, Frame, History, HistoryFile, OutputError, Row, Summary, Units, deformed_svg,
    energy_svg, labels, series_svg, vtu_bytes, write_pvd,
};
use crate::fclib;
use crate::spec::{Extent, FieldsEvery, Layout, Plot, Scene};

/// Writer of a run's results. Call [`Results::create`] before anything is computed, [`Results::start`] with the
/// initial state, [`Results::record`] after each accepted step, [`Results::frame`] when [`Results::wants_frame`]
/// says so, and [`Results::finish`] however the run ended.
#[derive(Debug)]
pub struct Results {
    folder: Folder,
    file: HistoryFile,
    layout: Layout,
    history: History,
    title: String,
    extent: Extent,
    schedule: Schedule,
    fields: Vec<(f64, String)>,
}

/// Which fields and pictures are still to come.
#[derive(Debug)]
struct Schedule {
    every: FieldsEvery,
    plots: Vec<Plot>,
    /// Pictures drawn so far, in step with `plots`.
    drawn: Vec<bool>,
    /// Next multiple of the interval \[s\].
    next: f64,
    /// Step of the last written fields.
    written: Option<usize>,
}

impl Schedule {
    fn fields_due(&self, step: usize, time: f64, last: bool) -> bool {
        if self.written == Some(step) {
            return false;
        }
        match self.every {
            FieldsEvery::Never => false,
            FieldsEvery::Steps(n) => last || step.is_multiple_of(n.max(1)),
            FieldsEvery::Interval(dt) => last || step == 0 || reached(time, self.next, dt),
        }
    }

    fn picture_due(&self, index: usize, time: f64, last: bool) -> bool {
        let due = match self.plots[index] {
            Plot::Deformed => last,
            Plot::DeformedAt(at) => last || reached(time, at, at),
            _ => false,
        };
        due && !self.drawn[index]
    }

    /// The next time after `time` at which something is due, for steps of `dt`: an interval shorter than a step asks
    /// for every step, wherever it ends.
    fn next_time(&self, time: f64, dt: f64) -> Option<f64> {
        let interval = match self.every {
            FieldsEvery::Interval(every) if every >= dt => Some(self.next),
            _ => None,
        };
        let plots = self.plots.iter().zip(&self.drawn);
        let pictures = plots.filter_map(|(plot, drawn)| match plot {
            Plot::DeformedAt(at) if !drawn => Some(*at),
            _ => None,
        });
        let ahead = pictures.chain(interval).filter(|at| *at > time);
        ahead.min_by(f64::total_cmp)
    }

    fn advance(&mut self, step: usize, time: f64) {
        self.written = Some(step);
        if let FieldsEvery::Interval(dt) = self.every {
            let periods = (time / dt * (1.0 + QUOTIENT_ROUND_OFF) + SAME_TIME).floor();
            self.next = (periods + 1.0) * dt;
        }
    }
}

/// Sums of steps reach a time only to round-off: a time this close to another, over the interval or the time itself,
/// is the same \[-\]; round-off of a million steps, with room.
const SAME_TIME: f64 = 1e-9;
/// Round-off of a quotient of two times, with room \[-\].
const QUOTIENT_ROUND_OFF: f64 = 1e-12;

/// Digits of a time in a file name at most; more would be those of a time without an exponent.
const MOST_DIGITS: usize = 24;

/// A time as a part of a file name.
fn in_file_name(time: f64) -> String {
    let plain = time.to_string();
    if plain.len() <= MOST_DIGITS {
        plain
    } else {
        format!("{time:e}")
    }
}

fn reached(time: f64, target: f64, scale: f64) -> bool {
    time >= target - SAME_TIME * scale.abs()
}

impl Results {
    /// Makes the folder, checks that it can be written to, removes an earlier run's results, opens `history.csv`.
    ///
    /// # Errors
    /// [`OutputError::Folder`], [`OutputError::File`].
    pub fn create(folder: &Path, scene: &Scene) -> Result<Results, OutputError> {
        let folder = Folder::create(folder)?;
        let layout = Layout::of(scene);
        let file = HistoryFile::create(&folder, &layout.header())?;
        let plots = scene.output.plots.clone();
        Ok(Results {
            folder,
            file,
            history: History::new(layout.header()),
            layout,
            title: scene.title.clone(),
            extent: Extent::of(scene),
            schedule: Schedule {
                every: scene.output.fields_every,
                drawn: vec![false; plots.len()],
                plots,
                next: 0.0,
                written: None,
            },
            fields: Vec::new(),
        })
    }

    /// The folder.
    pub fn folder(&self) -> &Folder {
        &self.folder
    }

    /// Columns of `history.csv`.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Rows so far, the initial state first when [`Results::start`] was called.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The state at the start: curves begin there, `history.csv` has accepted steps only.
    pub fn start(&mut self, row: &Row) {
        self.history.push(row.numbers(&self.layout));
    }

    /// Writes the contact problem of a step as FCLib, `contact_step_N.hdf5`.
    ///
    /// # Errors
    /// [`OutputError`].
    pub(crate) fn contact_problem(
        &self,
        step: usize,
        problem: &ContactProblem,
    ) -> Result<(), OutputError> {
        let name = format!("contact_step_{step}.hdf5");
        let path = self.folder.file(&name);
        let bytes = fclib::write::local(&path, problem).map_err(|e| OutputError::File {
            path: path.clone(),
            source: std::io::Error::other(e.to_string()),
        })?;
        self.folder.write(&name, &bytes)
    }

    /// Writes an accepted step to `history.csv`.
    ///
    /// # Errors
    /// [`OutputError::File`].
    pub fn record(&mut self, row: &Row) -> Result<(), OutputError> {
        let numbers = row.numbers(&self.layout);
        self.file.push(&numbers)?;
        self.history.push(numbers);
        Ok(())
    }

    /// True when [`Results::frame`] would write something: call it with step 0 at the start and with `last` at the
    /// end, also of a run that stops.
    #[must_use]
    pub fn wants_frame(&self, step: usize, time: f64, last: bool) -> bool {
        let pictures =
            (0..self.schedule.plots.len()).any(|i| self.schedule.picture_due(i, time, last));
        pictures || self.schedule.fields_due(step, time, last)
    }

    /// The next time after `time` at which fields or a picture are due \[s\], for nominal steps of `dt` \[s\].
    #[must_use]
    pub fn next_time(&self, time: f64, dt: f64) -> Option<f64> {
        self.schedule.next_time(time, dt)
    }

    /// Writes the fields and pictures that are due at this step.
    ///
    /// # Errors
    /// [`OutputError`]: fields that do not fit together, files that cannot be written.
    pub fn frame(&mut self, step: usize, frame: &Frame<'_>, last: bool) -> Result<(), OutputError> {
        if let Some(defect) = frame.defect() {
            return Err(OutputError::Frame {
                time: frame.time,
                defect,
            });
        }
        if self.schedule.fields_due(step, frame.time, last) {
            self.write_fields(step, frame)?;
        }
        for i in 0..self.schedule.plots.len() {
            if self.schedule.picture_due(i, frame.time, last) {
                self.schedule.drawn[i] = true;
                let name = match self.schedule.plots[i] {
                    Plot::DeformedAt(at) => format!("deformed_{}.svg", in_file_name(at)),
                    _ => "deformed.svg".to_owned(),
                };
                let svg = deformed_svg(&self.title, frame);
                self.draw(&name, svg)?;
            }
        }
        Ok(())
    }

    fn write_fields(&mut self, step: usize, frame: &Frame<'_>) -> Result<(), OutputError> {
        let name = format!("fields/step_{step:06}.vtu");
        let path = self.folder.file(&name);
        let bytes = vtu_bytes(frame).map_err(|source| OutputError::File { path, source })?;
        self.folder.write(&name, &bytes)?;
        self.fields.push((frame.time, name));
        self.folder
            .write("fields.pvd", write_pvd(&self.fields).as_bytes())?;
        self.schedule.advance(step, frame.time);
        Ok(())
    }

    fn draw(&self, name: &str, svg: Result<String, String>) -> Result<(), OutputError> {
        let svg = svg.map_err(|reason| OutputError::Plot {
            name: name.to_owned(),
            reason,
        })?;
        self.folder.write(name, svg.as_bytes())
    }

    /// Draws the curves and writes `summary.json`, which is written even when a curve fails.
    ///
    /// # Errors
    /// The first [`OutputError`].
    pub fn finish(self, summary: &Summary) -> Result<(), OutputError> {
        let drawn = self.curves();
        summary.write(&self.folder)?;
        drawn
    }

    fn curves(&self) -> Result<(), OutputError> {
        let mut free = 0;
        for plot in &self.schedule.plots {
            match plot {
                Plot::Energy => {
                    let unit = Units::of(self.extent).energy;
                    let svg = energy_svg(&self.title, &unit, &self.history);
                    self.draw("energy.svg", svg)?;
                }
                Plot::Force(name) => {
                    let axes = self.extent.force_axes();
                    self.vector(name, "force", "Force [N]", axes)?;
                }
                Plot::Moment(name) => {
                    let axes = self.extent.moment_axes();
                    self.vector(name, "moment", "Moment [N m]", axes)?;
                }
                Plot::Probe(name) => self.probe(name)?,
                Plot::History(columns) => {
                    free += 1;
                    let names = labels::distinct(columns);
                    let curves: Vec<_> = names.into_iter().zip(columns.iter().cloned()).collect();
                    let label = self.extent.label(labels::common(columns));
                    let svg = series_svg(&self.title, &label, &self.history, &curves);
                    self.draw(&format!("history_{free}.svg"), svg)?;
                }
                Plot::Deformed | Plot::DeformedAt(_) => {}
            }
        }
        Ok(())
    }

    fn vector(
        &self,
        name: &str,
        kind: &str,
        label: &str,
        axes: &[&str],
    ) -> Result<(), OutputError> {
        let columns = curves(&format!("{kind}.{name}"), axes);
        let title = format!("{}: {name}", self.title);
        let label = self.extent.label(label);
        let svg = series_svg(&title, &label, &self.history, &columns);
        self.draw(&format!("{kind}_{name}.svg"), svg)
    }

    fn probe(&self, name: &str) -> Result<(), OutputError> {
        let probes = self
            .layout
            .probes
            .iter()
            .filter(|probe| probe.name == *name);
        for quantity in probes.flat_map(|probe| &probe.quantities) {
            let column = format!("probe.{name}.{}", quantity.name());
            let columns: Vec<(String, String)> = match quantity.components() {
                1 => vec![(quantity.name().to_owned(), column)],
                _ => curves(&column, self.extent.vector_axes()),
            };
            let title = format!("{}: {name}", self.title);
            let label = self.extent.label(quantity.label());
            let svg = series_svg(&title, &label, &self.history, &columns);
            self.draw(&format!("probe_{name}_{}.svg", quantity.name()), svg)?;
        }
        Ok(())
    }
}

/// Name and column of components of a vector.
fn curves(column: &str, axes: &[&str]) -> Vec<(String, String)> {
    let curve = |axis: &&str| ((*axis).to_owned(), format!("{column}.{axis}"));
    axes.iter().map(curve).collect()
}
