//! Round numbers on an axis.

/// An axis from a round number to a round number, with a power of ten taken out of its labels.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    step: f64,
    /// Power of ten in the label of the axis.
    exponent: i32,
    /// The values are the exponents of powers of ten.
    powers: bool,
}

impl Scale {
    /// Around all values, with about `wanted` ticks; with `whole_steps` the ends are ticks, otherwise the ends are
    /// the values.
    pub(super) fn around(
        values: impl Iterator<Item = f64>,
        wanted: usize,
        whole_steps: bool,
    ) -> Scale {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|v| v.is_finite()) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // A range of round-off around a large value is a constant.
        let flat = (high - low) <= 1e-12 * low.abs().max(high.abs());
        if flat {
            let room = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
            (low, high) = (low - room, high + room);
        }
        let step = round_step((high - low) / wanted.max(1) as f64);
        if whole_steps {
            low = (low / step + 1e-6).floor() * step;
            high = (high / step - 1e-6).ceil() * step;
        }
        let largest = low.abs().max(high.abs());
        let magnitude = largest.log10().floor() as i32;
        let exponent = if (-2..5).contains(&magnitude) {
            0
        } else {
            magnitude.div_euclid(3) * 3
        };
        Scale {
            low,
            high,
            step,
            exponent,
            powers: false,
        }
    }

    /// Around the powers of ten of all positive values; everything here is in exponents.
    pub(super) fn powers(exponents: impl Iterator<Item = f64>) -> Scale {
        let mut around = Scale::around(exponents, 8, true);
        around.step = around.step.ceil();
        around.low = (around.low / around.step).floor() * around.step;
        around.high = (around.high / around.step).ceil() * around.step;
        Scale {
            exponent: 0,
            powers: true,
            ..around
        }
    }

    pub(super) fn ticks(&self) -> Vec<f64> {
        let first = (self.low / self.step - 1e-6).ceil() as i64;
        let last = (self.high / self.step + 1e-6).floor() as i64;
        (first..=last).map(|i| i as f64 * self.step).collect()
    }

    /// Number of ticks, for libraries that choose their own round numbers.
    pub(super) fn count(&self) -> usize {
        self.ticks().len()
    }

    /// A tick as text, the power of ten taken out.
    pub(super) fn tick(&self, value: f64) -> String {
        if self.powers {
            return power_of_ten(value.round() as i32);
        }
        let scale = 10.0_f64.powi(self.exponent);
        let decimals = (-(self.step / scale).log10().floor()).clamp(0.0, 12.0) as usize;
        let text = format!("{:.decimals$}", value / scale);
        // No "-0.0" at the origin.
        if text
            .trim_start_matches('-')
            .chars()
            .all(|c| c == '0' || c == '.')
        {
            text.trim_start_matches('-').to_owned()
        } else {
            text.replace('-', "\u{2212}")
        }
    }

    /// Label of the axis with the power of ten and the unit.
    pub(super) fn label(&self, quantity: &str, unit: &str) -> String {
        if self.exponent == 0 {
            return format!("{quantity} [{unit}]");
        }
        format!("{quantity} [{} {unit}]", power_of_ten(self.exponent))
    }
}

fn power_of_ten(exponent: i32) -> String {
    let digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let superscript = |c: char| match c.to_digit(10) {
        Some(d) => digits.chars().nth(d as usize).unwrap_or(c),
        None => '⁻',
    };
    let power: String = exponent.to_string().chars().map(superscript).collect();
    format!("10{power}")
}

/// 1, 2 or 5 times a power of ten, not below `rough`.
fn round_step(rough: f64) -> f64 {
    let power = 10.0_f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|f| f * power >= rough * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = Scale::around([0.0, 162.5].into_iter(), 7, true);
        assert_eq!(scale.ticks(), [0.0, 50.0, 100.0, 150.0, 200.0]);
        assert_eq!(scale.label("Energy", "J"), "Energy [J]");
        assert_eq!(scale.tick(50.0), "50");
    }

    #[test]
    fn small_values_move_their_power_into_the_label() {
        let scale = Scale::around([-5e-6, 2e-6].into_iter(), 7, true);
        assert_eq!(scale.label("Energy", "J"), "Energy [10⁻⁶ J]");
        assert_eq!(scale.tick(-5e-6), "\u{2212}5");
        assert_eq!(scale.tick(-0.0), "0");
    }

    #[test]
    fn a_constant_has_room_around_it() {
        for value in [0.0, 3.0, -2e9] {
            let scale = Scale::around([value; 3].into_iter(), 7, true);
            assert!(scale.low < value && value < scale.high);
            assert!(scale.count() >= 3);
        }
    }

    #[test]
    fn powers_of_ten_are_ticks() {
        let scale = Scale::powers([-3.2, 0.0, 2.7].into_iter());
        assert_eq!(scale.ticks(), [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]);
        assert_eq!(scale.tick(-3.0), "10⁻³");
        assert_eq!(scale.label("Force", "N"), "Force [N]");
        let wide = Scale::powers([-30.0, 0.0].into_iter());
        assert!(wide.count() < 10 && wide.low <= -30.0);
    }
}
