//! Cases: a scene, what is measured of it, and the meshes, steps and schemes over which that is done.

use crate::run::{Plan, Ran, compute, compute_all};

/// A number of a run beside what it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// What it is.
    pub name: &'static str,
    /// Its unit, after the scale.
    pub unit: &'static str,
    /// The number, in `unit`.
    pub value: f64,
    /// The closed form, in `unit`; the finest rung of a ladder stands in for it where there is none.
    pub exact: Option<f64>,
    /// What the error is relative to, in `unit`; the exact value without it.
    pub relative_to: Option<f64>,
}

impl Found {
    /// A number with a closed form.
    pub fn exact(name: &'static str, unit: &'static str, value: f64, exact: f64) -> Found {
        Found {
            name,
            unit,
            value,
            exact: Some(exact),
            relative_to: None,
        }
    }

    /// A number that is compared with that of the finest rung.
    pub fn open(name: &'static str, unit: &'static str, value: f64) -> Found {
        Found {
            name,
            unit,
            value,
            exact: None,
            relative_to: None,
        }
    }

    /// A number that should be zero, seen against a scale.
    pub fn zero(name: &'static str, unit: &'static str, value: f64, scale: f64) -> Found {
        Found {
            relative_to: Some(scale),
            ..Found::exact(name, unit, value, 0.0)
        }
    }

    /// Signed relative error \[-\]; `finest` is the same number of the finest rung. NaN where there is nothing to
    /// compare with.
    pub fn error(&self, finest: Option<f64>) -> f64 {
        let Some(exact) = self.exact.or(finest) else {
            return f64::NAN;
        };
        (self.value - exact) / self.relative_to.unwrap_or(exact.abs())
    }
}

/// One run of a ladder.
#[derive(Clone, Debug, PartialEq)]
pub struct Rung {
    /// How it is called in a table.
    pub label: String,
    /// Size of what is refined, relative to the scene's own, for the slope \[-\].
    pub size: f64,
    /// `path=value`.
    pub sets: Vec<String>,
}

/// Runs that differ in one thing that becomes finer.
#[derive(Clone, Debug, PartialEq)]
pub struct Ladder {
    /// What is refined, with which element or scheme.
    pub name: String,
    /// From coarse to fine.
    pub rungs: Vec<Rung>,
    /// Order of convergence of the first number of the case where theory tells it.
    pub order: Option<f64>,
    /// Numbers without a closed form are compared with the finest rung of the first ladder of the case, not of this
    /// one.
    pub against_first: bool,
}

impl Ladder {
    /// A ladder without rungs.
    pub fn new(name: impl Into<String>) -> Ladder {
        Ladder {
            name: name.into(),
            rungs: Vec::new(),
            order: None,
            against_first: false,
        }
    }

    /// The finest rung of the case's first ladder is the reference.
    #[must_use]
    pub fn against_first(self) -> Ladder {
        Ladder {
            against_first: true,
            ..self
        }
    }

    /// Adds a rung of this size.
    #[must_use]
    pub fn rung(mut self, label: impl Into<String>, size: f64, sets: &[&str]) -> Ladder {
        self.rungs.push(Rung {
            label: label.into(),
            size,
            sets: sets.iter().map(|s| (*s).to_owned()).collect(),
        });
        self
    }

    /// States the theoretical order.
    #[must_use]
    pub fn of_order(self, order: f64) -> Ladder {
        Ladder {
            order: Some(order),
            ..self
        }
    }

    /// Meshes of the scene with all cell counts multiplied.
    #[must_use]
    pub fn over_refine(name: &str, factors: &[usize], sets: &[&str]) -> Ladder {
        let with = |ladder: Ladder, factor: &usize| {
            let refine = format!("refine={factor}");
            let sets: Vec<&str> = sets.iter().copied().chain([refine.as_str()]).collect();
            ladder.rung(&refine, 1.0 / *factor as f64, &sets)
        };
        factors.iter().fold(Ladder::new(name), with)
    }

    /// The scene with other steps \[s\].
    #[must_use]
    pub fn over_dt(name: &str, steps: &[f64], sets: &[&str]) -> Ladder {
        let with = |ladder: Ladder, dt: &f64| {
            let step = format!("time.dt={dt:e}");
            let sets: Vec<&str> = sets.iter().copied().chain([step.as_str()]).collect();
            ladder.rung(format!("dt = {dt:e} s"), *dt, &sets)
        };
        steps.iter().fold(Ladder::new(name), with)
    }
}

/// A scene with a known or computed reference.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name, also of its plot.
    pub name: &'static str,
    /// What is compared with what, and the source.
    pub about: &'static str,
    /// Name of a built-in scene.
    pub scene: &'static str,
    /// `path=value` of every run.
    pub sets: Vec<String>,
    /// What is refined.
    pub ladders: Vec<Ladder>,
    /// The numbers of a run, the same for every rung; the first is the one that is drawn.
    pub measure: fn(&Ran) -> Result<Vec<Found>, String>,
}

/// What a run of a case gave.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Unknowns.
    pub dofs: usize,
    /// Accepted and rejected steps.
    pub steps: [usize; 2],
    /// CPU seconds of one thread.
    pub cpu_s: f64,
    /// The numbers.
    pub found: Vec<Found>,
}

impl Measured {
    /// Signed relative error of a number with a closed form \[-\]; NaN if there is none of that name.
    pub fn error(&self, name: &str) -> f64 {
        let found = self.found.iter().find(|f| f.name == name);
        found.map_or(f64::NAN, |f| f.error(None))
    }
}

impl Case {
    fn plan(&self, label: &str, sets: &[String]) -> Plan {
        let name = format!("{} {label}", self.name);
        Plan::new(name, self.scene, self.sets.iter().chain(sets).cloned())
    }

    fn measured(&self, ran: Result<Ran, String>) -> Result<Measured, String> {
        let ran = ran?.completed()?;
        Ok(Measured {
            found: (self.measure)(&ran)?,
            dofs: ran.summary.dofs,
            steps: [ran.summary.steps, ran.summary.rejected_steps],
            cpu_s: ran.summary.cpu_s,
        })
    }

    /// One run with these values, for tests.
    ///
    /// # Errors
    /// The run cannot be made or stops before its end.
    pub fn run(&self, sets: &[&str]) -> Result<Measured, String> {
        let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
        self.measured(compute(self.plan("", &sets)))
    }

    /// All ladders; one result a rung.
    pub fn climb(
        &self,
        told: &(dyn Fn(&Result<Ran, String>) + Sync),
    ) -> Vec<Vec<Result<Measured, String>>> {
        let rungs = self.ladders.iter().flat_map(|ladder| &ladder.rungs);
        let plans = rungs.map(|rung| self.plan(&rung.label, &rung.sets));
        let mut done = compute_all(plans.collect(), told).into_iter();
        let ladders = self.ladders.iter().map(|ladder| {
            let ran = done.by_ref().take(ladder.rungs.len());
            ran.map(|ran| self.measured(ran)).collect()
        });
        ladders.collect()
    }
}

/// Slope of log(error) over log(size), least squares; NaN below two points.
pub fn slope(sizes: &[f64], errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = sizes
        .iter()
        .zip(errors)
        .map(|(h, e)| (h.ln(), e.abs().ln()))
        .collect();
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let above: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let below: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    above / below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_power_is_its_exponent() {
        let sizes = [1.0, 0.5, 0.25];
        let errors = sizes.map(|h: f64| -3.0 * h.powf(1.7));
        assert!((slope(&sizes, &errors) - 1.7).abs() < 1e-12);
        assert!(slope(&sizes[..1], &errors[..1]).is_nan());
    }

    #[test]
    fn errors_are_relative_to_what_they_should_be() {
        assert_eq!(Found::exact("F", "N", 1.1, 1.0).error(None), 1.1 - 1.0);
        assert_eq!(Found::zero("v", "m/s", 0.5, 2.0).error(None), 0.25);
        assert_eq!(Found::open("t", "s", 3.0).error(Some(2.0)), 0.5);
        assert!(Found::open("t", "s", 3.0).error(None).is_nan());
    }
}
