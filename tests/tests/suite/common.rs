//! Runs scenes in memory and keeps what the stepper reports.

use nscd::{
    Counters, NoClock, NscdError, Observer, Rejection, State, StepReport, Stepper, Totals, march,
};
use scenarios::spec::{LoadedScene, Override, parse};
use scenarios::{Built, build};

/// A built-in scene with changed values.
pub(crate) fn scene(name: &str, sets: &[&str]) -> LoadedScene {
    scenarios::catalog::load(name, &overrides(sets))
        .unwrap_or_else(|e| panic!("{name} {sets:?}: {e}"))
}

/// A scene from its text.
pub(crate) fn scene_text(text: &str, sets: &[&str]) -> LoadedScene {
    parse("test.ron", text, &overrides(sets)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn overrides(sets: &[&str]) -> Vec<Override> {
    sets.iter().map(|s| s.parse().unwrap()).collect()
}

/// An accepted step: what was reported, and the state it led to.
#[derive(Debug)]
pub(crate) struct Step {
    pub(crate) report: StepReport,
    pub(crate) state: State,
    pub(crate) counters: Counters,
}

impl Step {
    pub(crate) fn energy(&self) -> f64 {
        self.state.kinetic_energy + self.state.strain_energy + self.state.adhesive_energy
    }
}

/// A run from start to end.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) built: Built,
    pub(crate) start: State,
    pub(crate) steps: Vec<Step>,
    pub(crate) totals: Totals,
    pub(crate) counters: Counters,
    pub(crate) end: Result<(), NscdError>,
}

#[derive(Default)]
struct Recorder {
    steps: Vec<Step>,
    rejected: usize,
}

impl Observer for Recorder {
    fn accepted(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        _: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        self.steps.push(Step {
            report: report.clone(),
            state: state.clone(),
            counters: *stepper.counters(),
        });
        Ok(())
    }

    fn rejected(&mut self, _: &Rejection) {
        self.rejected += 1;
    }
}

/// Builds and runs a scene; a run that stops early is not an error here.
pub(crate) fn try_run(loaded: &LoadedScene) -> Run {
    try_run_built(build(loaded).unwrap_or_else(|e| panic!("{e}")))
}

/// The same for a model that the test has changed.
pub(crate) fn try_run_built(built: Built) -> Run {
    let mut recorder = Recorder::default();
    let mut totals = Totals::default();
    let (start, end, counters) = {
        let mut stepper = Stepper::new(&built.model, Box::new(NoClock)).unwrap();
        let mut state = stepper.initial_state(built.velocity.clone()).unwrap();
        let start = state.clone();
        let end = march(
            &mut stepper,
            &mut state,
            built.span,
            &mut totals,
            &mut recorder,
        );
        (start, end, *stepper.counters())
    };
    assert_eq!(recorder.rejected as u64, counters.rejected_steps);
    if end.is_ok() {
        assert_eq!(recorder.rejected, totals.rejections.len());
    }
    Run {
        built,
        start,
        steps: recorder.steps,
        totals,
        counters,
        end,
    }
}

/// Builds and runs a scene to its end without a rejected step.
pub(crate) fn run(loaded: &LoadedScene) -> Run {
    let run = try_run(loaded);
    if let Err(error) = &run.end {
        panic!("{error}");
    }
    assert!(
        run.totals.rejections.is_empty(),
        "rejected: {:?}",
        run.totals.rejections
    );
    run
}

impl Run {
    pub(crate) fn last(&self) -> &Step {
        self.steps.last().unwrap()
    }

    /// Force of the first interface along axis `c` at the end of every step \[N\].
    pub(crate) fn contact_force(&self, c: usize) -> Vec<f64> {
        self.steps
            .iter()
            .map(|s| s.report.interfaces[0].force[c])
            .collect()
    }

    /// Fails unless every step is converged and its energy audit closes to `share` of `scale` \[J\].
    pub(crate) fn assert_audited(&self, scale: f64, share: f64) {
        let start = &self.start;
        let mut before = start.kinetic_energy + start.strain_energy + start.adhesive_energy;
        for step in &self.steps {
            let (t, report) = (step.report.time, &step.report);
            assert!(
                report.contact_error <= 1e-10,
                "t = {t}: contact error {:e}",
                report.contact_error
            );
            let open = report.energy.imbalance();
            assert!(
                open.abs() <= share * scale,
                "t = {t}: the audit leaves {open:e} J of {scale:e} J"
            );
            // The terms are increments; together they must be the energy of the state, too.
            let told = report.energy.kinetic + report.energy.strain + report.energy.adhesive;
            let change = step.energy() - before - told;
            assert!(
                change.abs() <= share * scale,
                "t = {t}: {change:e} J are in the state and not in the report"
            );
            before = step.energy();
        }
        let open = self.totals.energy.imbalance();
        assert!(
            open.abs() <= share * scale * (self.steps.len() as f64).sqrt(),
            "in total {open:e} J of {scale:e} J"
        );
    }

    /// Momentum \[N s\] of all bodies at a state.
    pub(crate) fn momentum(&self, state: &State) -> [f64; 3] {
        let mut p = vec![0.0; state.v.len()];
        self.built.model.mass.times(&state.v, &mut p);
        std::array::from_fn(|c| p.iter().skip(c).step_by(3).sum())
    }

    /// Angular momentum about the origin \[N m s\].
    pub(crate) fn angular_momentum(&self, state: &State) -> [f64; 3] {
        let mut p = vec![0.0; state.v.len()];
        self.built.model.mass.times(&state.v, &mut p);
        let points = self
            .built
            .model
            .solid
            .mesh()
            .points
            .iter()
            .zip(state.u.chunks_exact(3))
            .zip(p.chunks_exact(3));
        let mut sum = [0.0; 3];
        for ((x, u), p) in points {
            let x: [f64; 3] = std::array::from_fn(|c| x[c] + u[c]);
            for c in 0..3 {
                let (i, j) = ((c + 1) % 3, (c + 2) % 3);
                sum[c] += x[i] * p[j] - x[j] * p[i];
            }
        }
        sum
    }
}

/// Sum of `|F_k - 2 F_k+1 + F_k+2|`: what a reaction that jumps up and down every step is full of.
pub(crate) fn chatter(force: &[f64]) -> f64 {
    force
        .windows(3)
        .map(|f| (f[0] - 2.0 * f[1] + f[2]).abs())
        .sum()
}

/// Mean and standard deviation.
pub(crate) fn statistics(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (
        mean,
        (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt(),
    )
}
