//! Prescribed motion: tables of time, translation and rotation about an axis.

use nalgebra::Vector3;

use crate::error::FeError;

/// How a table is read between its entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Interpolation {
    /// Straight lines; the rate jumps at the entries.
    #[default]
    Linear,
    /// A cubic step in each interval: continuous rate, at rest at each entry, never beyond the two values.
    Smooth,
}

/// A scalar function of time, constant before its first and after its last entry.
///
/// Values have the unit of what they drive: \[m\], \[rad\] or a plain factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    interpolation: Interpolation,
}

impl Table {
    /// A table from entries (time \[s\], value), with strictly increasing times.
    ///
    /// # Errors
    /// [`FeError::Table`] if there is no entry, one is not finite, or times do not increase.
    pub fn new(points: Vec<(f64, f64)>, interpolation: Interpolation) -> Result<Table, FeError> {
        let refuse = |entry, reason| Err(FeError::Table { entry, reason });
        if points.is_empty() {
            return refuse(0, "a table needs at least one entry");
        }
        let finite = |&(t, v): &(f64, f64)| t.is_finite() && v.is_finite();
        if let Some(entry) = points.iter().position(|point| !finite(point)) {
            return refuse(entry, "time and value must be finite");
        }
        if let Some(entry) = (1..points.len()).find(|&k| points[k].0 <= points[k - 1].0) {
            return refuse(entry, "times must increase strictly");
        }
        let (times, values) = points.into_iter().unzip();
        Ok(Table {
            times,
            values,
            interpolation,
        })
    }

    /// The same value at all times. A value that is not finite is caught by what uses it.
    #[must_use]
    pub fn constant(value: f64) -> Table {
        Table {
            times: vec![0.0],
            values: vec![value],
            interpolation: Interpolation::Linear,
        }
    }

    /// Zero at all times.
    #[must_use]
    pub fn zero() -> Table {
        Table::constant(0.0)
    }

    /// Value at time `t` \[s\].
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        let Some((k, s)) = self.locate(t) else {
            let end = if t < self.times[0] {
                0
            } else {
                self.values.len() - 1
            };
            return self.values[end];
        };
        let (v0, v1) = (self.values[k], self.values[k + 1]);
        match self.interpolation {
            Interpolation::Linear => v0 + (v1 - v0) * s,
            Interpolation::Smooth => v0 + (v1 - v0) * (s * s * (3.0 - 2.0 * s)),
        }
    }

    /// Time derivative at `t` \[1/s times the unit of the values\]; at an entry, the rate just after it.
    #[must_use]
    pub fn rate(&self, t: f64) -> f64 {
        let Some((k, s)) = self.locate(t) else {
            return 0.0;
        };
        let slope = (self.values[k + 1] - self.values[k]) / (self.times[k + 1] - self.times[k]);
        match self.interpolation {
            Interpolation::Linear => slope,
            Interpolation::Smooth => slope * 6.0 * s * (1.0 - s),
        }
    }

    /// Times of the entries \[s\]: where a time step should end, since the rate or its derivative jumps.
    pub fn breakpoints(&self) -> &[f64] {
        &self.times
    }

    /// True if the value never changes.
    fn is_constant(&self) -> bool {
        self.values.iter().all(|v| *v == self.values[0])
    }

    /// True if the value is always zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.values.iter().all(|v| *v == 0.0)
    }

    /// Interval that holds `t` and the fraction of it that has passed, or nothing outside the table.
    fn locate(&self, t: f64) -> Option<(usize, f64)> {
        let after = self.times.partition_point(|&entry| entry <= t);
        if after == 0 || after == self.times.len() {
            return None;
        }
        let (t0, t1) = (self.times[after - 1], self.times[after]);
        Some((after - 1, (t - t0) / (t1 - t0)))
    }
}

/// Rotation about an axis fixed in the reference configuration, by the right-hand rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Rotation {
    point: Vector3<f64>,
    axis: Vector3<f64>,
    angle: Table,
}

impl Rotation {
    /// Rotation by `angle` \[rad\] about the line through `point` \[m\] along `axis` (any length).
    ///
    /// # Errors
    /// [`FeError::Parameter`] if the axis has no direction or the point is not finite.
    pub fn new(
        point: impl Into<Vector3<f64>>,
        axis: impl Into<Vector3<f64>>,
        angle: Table,
    ) -> Result<Rotation, FeError> {
        let (point, axis) = (point.into(), axis.into());
        let refuse = |what, value, bound| {
            Err(FeError::Parameter {
                place: "rotation".to_owned(),
                what,
                value,
                bound,
            })
        };
        if let Some(x) = point.iter().find(|x| !x.is_finite()) {
            return refuse("point on the axis [m]", *x, "must be finite");
        }
        // Scaled first: the squares of a tiny or huge axis would leave the range of f64.
        let largest = axis.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let scaled = axis / largest;
        let length = scaled.norm();
        if !(length.is_finite() && length > 0.0) {
            return refuse("length of the axis", largest, "must be positive and finite");
        }
        Ok(Rotation {
            point,
            axis: scaled / length,
            angle,
        })
    }

    /// A point on the axis \[m\].
    pub fn point(&self) -> Vector3<f64> {
        self.point
    }

    /// Unit vector along the axis.
    pub fn axis(&self) -> Vector3<f64> {
        self.axis
    }

    /// Angle \[rad\] over time.
    pub fn angle(&self) -> &Table {
        &self.angle
    }

    /// `R y - y` for an angle (Rodrigues), without cancellation for small angles.
    fn change(&self, y: &Vector3<f64>, angle: f64) -> Vector3<f64> {
        let (sin, sin_half) = (angle.sin(), (0.5 * angle).sin());
        let turned = self.axis.cross(y);
        let inward = self.axis.cross(&turned);
        sin * turned + 2.0 * sin_half * sin_half * inward
    }
}

/// Motion of a rigid body or a driven boundary: rotate about the reference axis, then translate.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// Translation along x, y, z \[m\].
    pub translation: [Table; 3],
    /// Rotation, if any.
    pub rotation: Option<Rotation>,
}

impl Default for Motion {
    fn default() -> Self {
        Motion::still()
    }
}

impl Motion {
    /// No motion at all.
    #[must_use]
    pub fn still() -> Motion {
        Motion {
            translation: std::array::from_fn(|_| Table::zero()),
            rotation: None,
        }
    }

    /// Translation only \[m\].
    #[must_use]
    pub fn translation(translation: [Table; 3]) -> Motion {
        Motion {
            translation,
            rotation: None,
        }
    }

    /// With a rotation, which comes before the translation.
    #[must_use]
    pub fn with_rotation(mut self, rotation: Rotation) -> Motion {
        self.rotation = Some(rotation);
        self
    }

    /// Displacement \[m\] at time `t` \[s\] of the material point that is at `x_ref` \[m\] in the reference.
    #[must_use]
    pub fn displacement(&self, x_ref: Vector3<f64>, t: f64) -> Vector3<f64> {
        let moved = self.translation_at(t);
        self.rotation.as_ref().map_or(moved, |rotation| {
            let arm = x_ref - rotation.point;
            rotation.change(&arm, rotation.angle.value(t)) + moved
        })
    }

    /// Velocity \[m/s\] at time `t` \[s\] of the material point that is at `x_ref` \[m\] in the reference. Where a
    /// table has a kink, the velocity just after it.
    #[must_use]
    pub fn velocity(&self, x_ref: Vector3<f64>, t: f64) -> Vector3<f64> {
        let sliding = Vector3::from_fn(|i, _| self.translation[i].rate(t));
        self.rotation.as_ref().map_or(sliding, |rotation| {
            let arm = x_ref - rotation.point;
            let turned = arm + rotation.change(&arm, rotation.angle.value(t));
            sliding + rotation.angle.rate(t) * rotation.axis.cross(&turned)
        })
    }

    /// Position \[m\] at time `t` \[s\] of the material point that is at `x_ref` \[m\] in the reference.
    #[must_use]
    pub fn position(&self, x_ref: Vector3<f64>, t: f64) -> Vector3<f64> {
        x_ref + self.displacement(x_ref, t)
    }

    /// Reference position \[m\] of the material point that is at `x` \[m\] at time `t` \[s\]: undoes
    /// [`Motion::position`].
    #[must_use]
    pub fn pull_back(&self, x: Vector3<f64>, t: f64) -> Vector3<f64> {
        let back = x - self.translation_at(t);
        self.rotation.as_ref().map_or(back, |rotation| {
            let arm = back - rotation.point;
            back + rotation.change(&arm, -rotation.angle.value(t))
        })
    }

    /// A direction fixed to the moving body (normal, axis) at time `t` \[s\].
    #[must_use]
    pub fn rotate(&self, direction: Vector3<f64>, t: f64) -> Vector3<f64> {
        self.rotation.as_ref().map_or(direction, |rotation| {
            direction + rotation.change(&direction, rotation.angle.value(t))
        })
    }

    /// True if nothing moves at any time: displacement and velocity are always zero.
    #[must_use]
    pub fn is_still(&self) -> bool {
        let turns = self.rotation.as_ref().is_some_and(|r| !r.angle.is_zero());
        !turns && self.translation.iter().all(Table::is_zero)
    }

    /// Times \[s\] at which some rate may jump, sorted, without repeats.
    #[must_use]
    pub fn breakpoints(&self) -> Vec<f64> {
        let angle = self.rotation.as_ref().map(|rotation| &rotation.angle);
        let tables = self.translation.iter().chain(angle);
        let mut times: Vec<f64> = tables
            .filter(|table| !table.is_constant())
            .flat_map(|table| table.breakpoints().iter().copied())
            .collect();
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        times
    }

    fn translation_at(&self, t: f64) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.translation[i].value(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table(interpolation: Interpolation) -> impl Strategy<Value = Table> {
        prop::collection::vec((0.05..2.0_f64, -3.0..3.0_f64), 1..6).prop_map(move |steps| {
            let mut t = -1.0;
            let points = steps.into_iter().map(|(dt, v)| {
                t += dt;
                (t, v)
            });
            Table::new(points.collect(), interpolation).unwrap()
        })
    }

    fn any_table() -> impl Strategy<Value = Table> {
        prop_oneof![table(Interpolation::Linear), table(Interpolation::Smooth)]
    }

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-2.0..2.0_f64).prop_map(Vector3::from)
    }

    fn motion() -> impl Strategy<Value = Motion> {
        let axis = vector().prop_filter("axis", |a| a.norm_squared() > 0.1);
        let smooth = || table(Interpolation::Smooth);
        (prop::array::uniform3(smooth()), vector(), axis, smooth()).prop_map(
            |(translation, point, axis, angle)| Motion {
                translation,
                rotation: Some(Rotation::new(point, axis, angle).unwrap()),
            },
        )
    }

    #[test]
    fn tables_refuse_nonsense() {
        let table = |points: &[(f64, f64)]| Table::new(points.to_vec(), Interpolation::Linear);
        assert!(table(&[]).is_err());
        assert!(table(&[(0.0, 1.0), (0.0, 2.0)]).is_err());
        assert!(table(&[(1.0, 1.0), (0.0, 2.0)]).is_err());
        assert!(table(&[(0.0, f64::NAN)]).is_err());
        assert!(table(&[(f64::INFINITY, 0.0)]).is_err());
        assert!(Rotation::new([0.0; 3], [0.0; 3], Table::zero()).is_err());
        assert!(Rotation::new([0.0; 3], [f64::NAN, 0.0, 1.0], Table::zero()).is_err());
        assert!(Rotation::new([f64::NAN; 3], [0.0, 0.0, 1.0], Table::zero()).is_err());
    }

    #[test]
    fn quarter_turn_then_translation() {
        let ramp = |v| Table::new(vec![(0.0, 0.0), (1.0, v)], Interpolation::Linear).unwrap();
        let quarter = ramp(std::f64::consts::FRAC_PI_2);
        let motion = Motion {
            translation: [Table::zero(), Table::zero(), ramp(5.0)],
            rotation: Some(Rotation::new([1.0, 0.0, 0.0], [0.0, 0.0, 9.0], quarter).unwrap()),
        };
        let x = motion.position(Vector3::new(3.0, 0.0, 1.0), 1.0);
        let expected = [1.0, 2.0, 6.0];
        for i in 0..3 {
            assert!((x[i] - expected[i]).abs() < 1e-15);
        }
        assert!(!motion.is_still());
        assert!(Motion::still().is_still());
        assert_eq!(motion.breakpoints(), [0.0, 1.0]);
        assert!(Motion::still().breakpoints().is_empty());
    }

    proptest! {
        #[test]
        fn tables_pass_through_their_entries_and_stay_constant_outside(table in any_table()) {
            for (k, &t) in table.times.iter().enumerate() {
                prop_assert!((table.value(t) - table.values[k]).abs() < 1e-14);
            }
            let (first, last) = (table.times[0], table.times[table.times.len() - 1]);
            prop_assert_eq!(table.value(first - 1.0), table.values[0]);
            prop_assert_eq!(table.value(last + 1.0), table.values[table.values.len() - 1]);
            prop_assert_eq!(table.rate(first - 1.0), 0.0);
            prop_assert_eq!(table.rate(last), 0.0);
        }

        #[test]
        fn tables_are_monotone_in_each_interval(table in any_table()) {
            for k in 1..table.times.len() {
                let (t0, t1) = (table.times[k - 1], table.times[k]);
                let up = table.values[k] >= table.values[k - 1];
                let mut before = table.values[k - 1];
                for m in 1..=50 {
                    let now = table.value(t0 + (t1 - t0) * f64::from(m) / 50.0);
                    let change = if up { now - before } else { before - now };
                    prop_assert!(change >= -1e-14);
                    before = now;
                }
            }
        }

        #[test]
        fn tables_are_continuous_and_smooth_ones_have_a_continuous_rate(table in any_table()) {
            let h = 1e-9;
            for &t in &table.times {
                prop_assert!((table.value(t + h) - table.value(t - h)).abs() < 1e-6);
                if table.interpolation == Interpolation::Smooth {
                    prop_assert!(table.rate(t).abs() < 1e-12);
                    prop_assert!(table.rate(t - h).abs() < 1e-4);
                }
            }
        }

        #[test]
        fn rate_is_the_derivative_of_the_value(table in any_table(), t in -1.5..6.0_f64) {
            let h = 1e-6;
            prop_assume!(table.times.iter().all(|entry| (entry - t).abs() > 2.0 * h));
            let difference = (table.value(t + h) - table.value(t - h)) / (2.0 * h);
            prop_assert!((table.rate(t) - difference).abs() < 1e-6 * (1.0 + difference.abs()));
        }

        #[test]
        fn velocity_is_the_derivative_of_the_displacement(
            motion in motion(), x in vector(), t in -1.0..5.0_f64,
        ) {
            let h = 1e-6;
            let (after, before) = (motion.displacement(x, t + h), motion.displacement(x, t - h));
            let velocity = motion.velocity(x, t);
            for i in 0..3 {
                let difference = (after[i] - before[i]) / (2.0 * h);
                // The second derivative of a smooth table jumps at its entries: an error of order h remains.
                prop_assert!((velocity[i] - difference).abs() < 0.05);
                let near = motion.breakpoints().iter().any(|b| (b - t).abs() < 2.0 * h);
                prop_assert!(near || (velocity[i] - difference).abs() < 1e-4);
            }
        }

        #[test]
        fn motion_is_rigid_and_pull_back_undoes_it(
            motion in motion(), x in vector(), y in vector(), t in -1.0..5.0_f64,
        ) {
            let distance = |a: Vector3<f64>, b: Vector3<f64>| (a - b).norm();
            let (px, py) = (motion.position(x, t), motion.position(y, t));
            prop_assert!((distance(px, py) - distance(x, y)).abs() < 1e-12);
            prop_assert!(distance(motion.pull_back(px, t), x) < 1e-12);
            let turned = motion.rotate(y - x, t);
            prop_assert!(distance(turned, py - px) < 1e-12);
        }
    }
}
