//! Time, solver and output of a scene.

use super::{Checker, MAX_STEPS, unknown};
use crate::spec::{ContactLevel, Extent, FieldsEvery, Inertia, Layout, Plot, Probe};

/// Most damping of a mass over a step, or of a stiffness in steps \[-\]: forces of 1e-12 of another one keep four
/// digits.
const MOST_DAMPING: f64 = 1e12;
/// Smallest relative error that a solver may be asked for \[-\]: round-off of a few numbers.
const TIGHTEST: f64 = 1e-15;
/// Largest relative error of the contact law \[-\]: forces of contacts have two digits then.
const LOOSEST_CONTACT: f64 = 1e-2;
/// Largest relative residual \[-\]: what is left is a part of the forces, and the audit of the energies shows it.
const LOOSEST_NEWTON: f64 = 0.5;
/// More iterations than this are a slip: they last longer than any step is worth \[-\].
const MOST_ITERATIONS: usize = 100_000_000;
/// Smallest step that the time at the end of the run still feels, with room, over that time \[-\].
const SMALLEST_STEP: f64 = 1e-14;

impl Checker<'_> {
    pub(super) fn time(&mut self) {
        let time = &self.scene.time;
        self.positive(time.end, "time.end", "s");
        self.positive(time.dt, "time.dt", "s");
        if time.end > 0.0 && time.end.is_finite() && time.dt > 0.0 {
            self.require(
                time.dt <= time.end,
                "time.dt",
                format!("must not exceed time.end = {} [s]", time.end),
            );
            let many = format!(
                "makes {:e} steps to time.end; at most {MAX_STEPS:e}",
                time.end / time.dt
            );
            self.require(time.end / time.dt <= MAX_STEPS, "time.dt", many);
        }
        self.between(time.theta, 0.5, 1.0, "time.theta", "-");
        self.between(time.xi, 0.5, 1.0, "time.xi", "-");
        let still = time.inertia == Inertia::QuasiStatic && time.contact == ContactLevel::Velocity;
        self.require(
            !still,
            "time.contact",
            "must be Position in a QuasiStatic scene, which has no velocities",
        );
        if let Some(min_dt) = time.min_dt {
            let fine = min_dt > 0.0 && min_dt <= time.dt;
            self.require(
                fine,
                "time.min_dt",
                format!(
                    "must be greater than 0 and at most time.dt = {} [s]",
                    time.dt
                ),
            );
            let least = SMALLEST_STEP * time.end;
            self.require(
                !fine || min_dt >= least,
                "time.min_dt",
                format!("must be {least:e} [s] or more: a shorter step is lost in the round-off of time.end"),
            );
        }
        self.damping();
    }

    /// Forces of damping so large that all others drown in their round-off are a slip.
    fn damping(&mut self) {
        let (damping, dt) = (&self.scene.damping, self.scene.time.dt);
        for (value, most, name, unit, bound) in [
            (damping.mass, MOST_DAMPING / dt, "mass", "1/s", "/ time.dt"),
            (
                damping.stiffness,
                MOST_DAMPING * dt,
                "stiffness",
                "s",
                "time.dt",
            ),
        ] {
            let path = format!("damping.{name}");
            self.not_negative(value, &path, unit);
            self.require(
                !(value.is_finite() && dt > 0.0 && value > most),
                &path,
                format!(
                    "must be at most {MOST_DAMPING:e} {bound} = {most:e} [{unit}]: beyond that all other forces drown in the round-off \
                     of damping"
                ),
            );
        }
    }

    pub(super) fn solver(&mut self) {
        let solver = &self.scene.solver;
        for (value, name, most) in [
            (
                solver.contact_tolerance,
                "contact_tolerance",
                LOOSEST_CONTACT,
            ),
            (solver.newton_tolerance, "newton_tolerance", LOOSEST_NEWTON),
        ] {
            let message = format!(
                "must be from {TIGHTEST:e} to {most:e} [-]: below, round-off is larger; above, forces would be guessed and not \
                 solved for"
            );
            let fine = value.is_none_or(|v| (TIGHTEST..=most).contains(&v));
            self.require(fine, &format!("solver.{name}"), message);
        }
        for (value, name) in [
            (solver.max_contact_iterations, "max_contact_iterations"),
            (solver.max_newton, "max_newton"),
        ] {
            let message = format!("must be 1 or more and at most {MOST_ITERATIONS} [-]");
            let fine = value.is_none_or(|v| (1..=MOST_ITERATIONS).contains(&v));
            self.require(fine, &format!("solver.{name}"), message);
        }
    }

    pub(super) fn output(&mut self) {
        let output = &self.scene.output;
        match output.fields_every {
            FieldsEvery::Steps(n) => {
                self.require(n >= 1, "output.fields_every", "must be 1 or more steps")
            }
            FieldsEvery::Interval(dt) => self.positive(dt, "output.fields_every", "s"),
            FieldsEvery::Never => {}
        }
        for (i, plot) in output.plots.iter().enumerate() {
            self.plot(plot, &format!("output.plots.{i}"));
        }
        for (name, probe) in &output.probes {
            self.probe(probe, &format!("output.probes.{name}"));
        }
    }

    fn plot(&mut self, plot: &Plot, path: &str) {
        let scene = self.scene;
        match plot {
            Plot::Energy | Plot::Deformed => {}
            // A time beyond the end gives the picture of the end.
            Plot::DeformedAt(t) => {
                self.require(*t >= 0.0 && t.is_finite(), path, "must be 0 s or more");
            }
            Plot::Force(name) | Plot::Moment(name) => {
                let moment = matches!(plot, Plot::Moment(_));
                let none = moment && Extent::of(scene).moment_axes().is_empty();
                let message = "is impossible: forces on a whole ring have no moment";
                self.require(!none, path, message);
                let names = scene.interfaces.keys().chain(scene.motions.keys());
                let found = names.clone().any(|n| n == name);
                let names = names.map(String::as_str);
                self.require(found, path, unknown("interface or motion", name, names));
            }
            Plot::Probe(name) => self.known(&scene.output.probes, name, "probe", path),
            Plot::History(columns) => {
                self.require(!columns.is_empty(), path, "must name at least one column");
                let header = Layout::of(scene).header();
                for (k, column) in columns.iter().enumerate() {
                    let names = header.iter().map(String::as_str);
                    let known = header.contains(column);
                    let path = format!("{path}.{k}");
                    self.require(known, &path, unknown("column", column, names));
                }
            }
        }
    }

    fn probe(&mut self, probe: &Probe, path: &str) {
        let bodies = &self.scene.bodies;
        self.known(bodies, &probe.body, "body", &format!("{path}.body"));
        self.finite(&probe.node, &format!("{path}.node"));
        let asked = &probe.quantities;
        let mut pairs = asked.iter().enumerate();
        let once = pairs.all(|(i, q)| !asked[..i].contains(q));
        self.require(
            once && !asked.is_empty(),
            &format!("{path}.quantities"),
            "must name at least one quantity, each once",
        );
    }
}
