//! From start to end: step control, observers, totals.

use crate::audit::EnergyAudit;
use crate::error::{NscdError, StepFailure};
use crate::model::Model;
use crate::report::{EnergyTerms, Overlap, Rejection, StepReport};
use crate::state::State;
use crate::stepper::{SAME_TIME, Stepper};

/// Is told about every accepted and rejected step.
pub trait Observer {
    /// A step was accepted.
    ///
    /// # Errors
    /// Anything that should end the run, e.g. a full disk.
    fn accepted(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;

    /// A step was rejected and will be cut.
    fn rejected(&mut self, _rejection: &Rejection) {}

    /// The next time after `time` that the observer wants to see exactly \[s\]. The nominal steps never change for it:
    /// a step ends there where cut steps have left their grid.
    fn next_time(&self, _time: f64) -> Option<f64> {
        None
    }
}

/// Wants to know nothing.
impl Observer for () {
    fn accepted(
        &mut self,
        _: &Stepper<'_>,
        _: &State,
        _: &StepReport,
        _: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        Ok(())
    }
}

/// Sums and extremes over the accepted steps.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Totals {
    /// Energy at the start \[J\].
    pub initial_energy: f64,
    /// Largest sum of kinetic, strain and adhesive energy (without signs) at the end of a step \[J\].
    pub largest_energy: f64,
    /// Energy terms summed over the steps.
    pub energy: EnergyTerms,
    /// Extremes of the energies.
    pub audit: EnergyAudit,
    /// Deepest penetration at the end of a step, and of slave nodes without contact at the end of the run \[m\].
    pub max_penetration: f64,
    /// Largest relative error of the contact law in an accepted step \[-\].
    pub max_contact_error: f64,
    /// Largest relative residual in an accepted step \[-\].
    pub max_residual: f64,
    /// Slave nodes inside their masters at the end of the run.
    pub overlap: Option<Overlap>,
    /// Rejected steps.
    pub rejections: Vec<Rejection>,
}

impl Totals {
    fn add(&mut self, report: &StepReport, state: &State) {
        self.energy.add(&report.energy);
        self.audit.follow(state, &self.energy);
        let energy = state.kinetic_energy + state.strain_energy.abs() + state.adhesive_energy.abs();
        self.largest_energy = self.largest_energy.max(energy);
        self.max_penetration = self.max_penetration.max(report.penetration);
        self.max_contact_error = self.max_contact_error.max(report.contact_error);
        self.max_residual = self.max_residual.max(report.residual);
    }
}

/// Span of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Span {
    /// End time \[s\].
    pub end: f64,
    /// Nominal step \[s\].
    pub dt: f64,
}

impl Span {
    /// From zero to `end` \[s\] in steps of `dt` \[s\].
    #[must_use]
    pub const fn new(end: f64, dt: f64) -> Self {
        Self { end, dt }
    }
}

/// Runs from `state` to the end of the span. A failed step is cut in half, with its reason kept,
/// and grown again; below the smallest step the run stops. `state` is always the last accepted one
/// and `totals` what led there, so that nothing computed is lost.
///
/// ```
/// use nscd::fe_core::{BoxMesh, Solid, solid_block};
/// use nscd::{Model, NoClock, Span, Stepper, Totals, march};
/// use hyperelastic::{ElasticConstants, NeoHookean};
///
/// // A bar in free flight keeps its energy.
/// let mesh = BoxMesh::uniform([0.0; 3], [1.0, 1.0, 4.0], [1, 1, 4]).generate("bar")?.validated()?;
/// let law = NeoHookean::new(ElasticConstants::from_shear_lame(2e5, 3e5)?)?;
/// let bar = solid_block(&mesh, 0, law, 1000.0)?;
/// let model = Model::new(Solid::new(mesh, vec![bar])?);
/// let mut stepper = Stepper::new(&model, Box::new(NoClock))?;
/// let mut state = stepper.initial_state([1.0, 0.0, 0.0].repeat(20))?;
/// let mut totals = Totals::default();
/// let span = Span::new(0.1, 0.01);
/// march(&mut stepper, &mut state, span, &mut totals, &mut ())?;
/// assert_eq!(stepper.counters().steps, 10);
/// assert!((state.kinetic_energy / totals.initial_energy - 1.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NscdError::Stopped`] with the last reason, [`NscdError::Observer`].
pub fn march(
    stepper: &mut Stepper<'_>,
    state: &mut State,
    span: Span,
    totals: &mut Totals,
    observer: &mut dyn Observer,
) -> Result<(), NscdError> {
    totals.initial_energy = state.kinetic_energy + state.strain_energy + state.adhesive_energy;
    totals.audit = EnergyAudit::new(stepper.model(), totals.initial_energy);
    let end = advance(stepper, state, span, totals, observer);
    totals.overlap = stepper.overlap(state);
    let depth = totals.overlap.map_or(0.0, |overlap| overlap.depth);
    totals.max_penetration = totals.max_penetration.max(depth);
    end
}

fn advance(
    stepper: &mut Stepper<'_>,
    state: &mut State,
    span: Span,
    totals: &mut Totals,
    observer: &mut dyn Observer,
) -> Result<(), NscdError> {
    let mut control = Control::new(stepper.model(), span, state.time);
    while let Some(dt) = control.next(state.time, observer.next_time(state.time)) {
        match stepper.step(state, dt) {
            Ok((next, report)) => {
                *state = next;
                control.accepted(state);
                stepper.count_step(true);
                totals.add(&report, state);
                observer
                    .accepted(stepper, state, &report, totals)
                    .map_err(|source| NscdError::Observer {
                        time: state.time,
                        source,
                    })?;
            }
            Err(reason) => {
                stepper.count_step(false);
                let rejection = Rejection {
                    time: state.time,
                    dt,
                    reason,
                };
                observer.rejected(&rejection);
                let reason = rejection.reason.clone();
                totals.rejections.push(rejection);
                control.rejected(state.time, dt, &reason)?;
            }
        }
    }
    Ok(())
}

/// Chooses the steps: the nominal grid, never across a breakpoint, halved after failures.
#[derive(Debug)]
struct Control {
    span: Span,
    /// Where the run starts \[s\].
    start: f64,
    /// End times that no step crosses, increasing; the nominal grid between them.
    targets: Vec<f64>,
    /// Another time at which the step under way ends \[s\].
    wanted: Option<f64>,
    /// Current step as a fraction `2^-level` of the nominal one.
    level: u32,
    smallest: f64,
    /// Accepted steps since the level last changed.
    successes: usize,
    growth_after: usize,
    /// Accepted steps before a growth to the level that failed last: twice as many each time.
    patience: usize,
    /// The level that a growth led to and that failed soon.
    failed: Option<u32>,
    /// Whether the level last changed by growing.
    grown: bool,
}

/// A step is not cut for a time of whoever watches that is nearer than this part of it, so that no sliver can end a
/// run \[-\]. Equal steps to a time on the nominal grid never leave less than a quarter.
const NEAREST: f64 = 0.2;
/// Patience never exceeds this multiple of its setting \[-\]: growth that always fails costs little, one step in 32 by
/// default, and growth that succeeds again is not missed for long.
const MOST_PATIENCE: usize = 16;
/// Breakpoints from this part of the end time on are the end \[-\]: a table that ends with the run may miss it by
/// round-off.
const BEFORE_END: f64 = 1.0 - 1e-12;
/// A rest of the way to a target below this part of a step gets no step of its own: the steps before it stretch \[-\].
/// Far above the round-off of a sum of steps, and too little to matter to a step.
const SLIVER: f64 = 1e-6;
/// Factor from the length of one level to the next \[-\]: a power of two, so that lengths are exact.
const HALF: f64 = 0.5;
/// A step that failed is followed by one below this part of it, and not below half of that \[-\]: by its half where its
/// length was one of the levels, which a step to a target is not.
const CUT: f64 = 0.75;

impl Control {
    fn new(model: &Model, span: Span, start: f64) -> Self {
        let mut targets: Vec<f64> = model
            .breakpoints()
            .into_iter()
            .filter(|t| *t > 0.0 && *t < span.end * BEFORE_END)
            .collect();
        targets.push(span.end);
        Self {
            span,
            start,
            targets,
            wanted: None,
            level: 0,
            smallest: span.dt * model.settings.smallest_step,
            successes: 0,
            growth_after: model.settings.growth_after,
            patience: model.settings.growth_after,
            failed: None,
            grown: false,
        }
    }

    /// Length of a step of the present level \[s\].
    fn length(&self) -> f64 {
        self.span.dt * HALF.powi(self.level as i32)
    }

    /// Length of the next step from time `t`, `None` at the end. The steps to the next target are
    /// made equal, so that round-off never leaves a sliver. `asked` is a time for whoever watches: off the nominal grid
    /// a target, too.
    fn next(&mut self, t: f64, asked: Option<f64>) -> Option<f64> {
        let wish = self.length();
        let is_ahead = |target: &&f64| **target > t + SAME_TIME * wish;
        let target = *self.targets.iter().find(is_ahead)?;
        let cut = self.level > 0 || !self.on_grid(t, target);
        self.wanted = asked.filter(|&at| cut && at - t > NEAREST * wish && at < target);
        let target = self.wanted.unwrap_or(target);
        let count = ((target - t) / wish - SLIVER).ceil().max(1.0);
        let even = (target - t) / count;
        // The same bits step after step keep the factorization.
        Some(if (even - wish).abs() < SAME_TIME * wish {
            wish
        } else {
            even
        })
    }

    /// Whether uncut steps to `target` pass through `t`.
    fn on_grid(&self, t: f64, target: f64) -> bool {
        let before = self.targets.iter().rev();
        let from = before.copied().find(|&end| end < target);
        let from = from.unwrap_or(self.start).max(self.start);
        let count = ((target - from) / self.span.dt - SLIVER).ceil().max(1.0);
        let steps = (t - from) / (target - from) * count;
        (steps - steps.round()).abs() < SLIVER
    }

    fn accepted(&mut self, state: &mut State) {
        state.time = self.exact(state.time);
        self.grow();
    }

    /// Sums of steps reach the nominal grid and the targets up to round-off: the time that is meant.
    fn exact(&self, time: f64) -> f64 {
        let grid = (time / self.span.dt).round() * self.span.dt;
        let places = self.targets.iter().copied().chain([grid]);
        places
            .chain(self.wanted)
            .find(|t| (t - time).abs() < SAME_TIME * self.span.dt)
            .unwrap_or(time)
    }

    fn grow(&mut self) {
        self.successes += 1;
        if self.level == 0 || self.successes < self.wait() {
            return;
        }
        if self.failed.is_some_and(|failed| self.level <= failed) {
            self.failed = None;
            self.patience = self.growth_after;
        }
        self.level -= 1;
        self.successes = 0;
        self.grown = true;
    }

    /// Steps to accept before the level falls. Below the level that failed the way up is free.
    fn wait(&self) -> usize {
        match self.failed {
            Some(failed) if self.level <= failed + 1 => self.patience,
            _ => self.growth_after,
        }
    }

    fn rejected(&mut self, time: f64, dt: f64, reason: &StepFailure) -> Result<(), NscdError> {
        if self.grown && self.successes < self.patience {
            if self.failed != Some(self.level) {
                self.patience = self.growth_after;
            }
            self.failed = Some(self.level);
            self.patience = (2 * self.patience).min(MOST_PATIENCE * self.growth_after);
        }
        self.successes = 0;
        self.grown = false;
        while self.length() >= CUT * dt {
            self.level += 1;
        }
        if dt * HALF < self.smallest {
            return Err(NscdError::Stopped {
                time,
                smallest: dt,
                failure: reason.clone(),
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn control(span: Span) -> Control {
        Control {
            span,
            start: 0.0,
            targets: vec![span.end],
            wanted: None,
            level: 0,
            smallest: 1e-3,
            successes: 0,
            growth_after: 2,
            patience: 2,
            failed: None,
            grown: false,
        }
    }

    /// Steps of a control for which every step above `longest(steps so far)` fails: accepted and rejected ones.
    fn counts(longest: impl Fn(usize) -> f64, steps: usize) -> [usize; 2] {
        let mut control = control(Span { end: 1e9, dt: 1.0 });
        let (mut t, mut made) = (0.0, [0, 0]);
        while made[0] < steps {
            let dt = control.next(t, None).unwrap();
            if dt > longest(made[0]) {
                control
                    .rejected(t, dt, &StepFailure::NotFinite { node: 0 })
                    .unwrap();
                made[1] += 1;
            } else {
                t += dt;
                control.grow();
                made[0] += 1;
            }
        }
        made
    }

    #[test]
    fn a_step_that_cannot_grow_is_tried_less_and_less() {
        assert_eq!(counts(|_| 1.0, 100), [100, 0]);
        let [made, failed] = counts(|_| 0.3, 1000);
        // Growth is tried after 2, 4, 8, 16 and then every 32 steps, and costs one failure each time.
        assert_eq!(failed, 2 + 4 + (made - 30) / 32);
    }

    /// Times of 20 steps of which the one from `fails` is cut twice, for somebody who wants to see `times`.
    fn seen(times: &[f64], fails: f64) -> Vec<f64> {
        let mut control = control(Span { end: 1e9, dt: 1.0 });
        let (mut t, mut all, mut cuts) = (0.0, Vec::new(), 0);
        while all.len() < 20 {
            let asked = times.iter().copied().find(|&at| at > t);
            let dt = control.next(t, asked).unwrap();
            if t == fails && cuts < 2 {
                cuts += 1;
                let reason = StepFailure::NotFinite { node: 0 };
                control.rejected(t, dt, &reason).unwrap();
                continue;
            }
            t = control.exact(t + dt);
            control.grow();
            all.push(t);
        }
        all
    }

    #[test]
    fn a_time_that_is_asked_for_ends_a_step_where_cuts_have_left_the_grid() {
        let nominal: Vec<f64> = (1..=20).map(f64::from).collect();
        assert_eq!(seen(&[3.0, 4.5, 7.25, 9.0], -1.0), nominal);
        // Two quarters and two halves from 1 to 2.5, where the grid is left for good, but for what is asked for.
        assert_eq!(seen(&[], 1.0)[..7], [1.0, 1.25, 1.5, 2.0, 2.5, 3.5, 4.5]);
        let cut = seen(&[4.2, 6.0], 1.0);
        assert!(cut.contains(&4.2) && cut.contains(&6.0), "{cut:?}");
        let lengths = cut.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(
            lengths.into_iter().all(|dt| dt > 0.2 && dt < 1.0 + 1e-9),
            "{cut:?}"
        );
        // Back on the grid from there on.
        assert_eq!(
            cut[cut.len() - 5..],
            [13.0, 14.0, 15.0, 16.0, 17.0],
            "{cut:?}"
        );
    }

    #[test]
    fn the_way_up_from_a_single_short_step_is_not_held_up_by_other_failures() {
        let [_, steady] = counts(|_| 0.3, 400);
        let [_, once] = counts(|n| if n == 200 { 0.02 } else { 0.3 }, 400);
        // Four or five cuts down to 1/64, and few tries more of what fails anyway.
        assert!((once - steady) <= 6, "{once} {steady}");
        let control = |n: usize| if n == 200 { 0.02 } else { 1.0 };
        // Two steps on each of six levels, and all others long.
        assert_eq!(counts(control, 400), [400, 6]);
    }
}
