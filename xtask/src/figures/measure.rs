//! Numbers read off curves and states.

use ::tests::Ran;
use nscd::State;
use scenarios::Fields;

/// Largest value and where it is.
pub(super) fn peak(x: &[f64], y: &[f64]) -> (f64, f64) {
    let points = x.iter().zip(y).filter(|(_, y)| y.is_finite());
    let best = points.max_by(|a, b| a.1.total_cmp(b.1));
    best.map_or((f64::NAN, f64::NAN), |(x, y)| (*x, *y))
}

/// First place where the value exceeds `level`.
pub(super) fn first_above(x: &[f64], y: &[f64], level: f64) -> Option<f64> {
    x.iter().zip(y).find(|(_, y)| **y > level).map(|(x, _)| *x)
}

/// First place behind the peak where the value is below `level`.
pub(super) fn first_below_after_peak(x: &[f64], y: &[f64], level: f64) -> Option<f64> {
    let (top, _) = peak(x, y);
    let behind = x.iter().zip(y).filter(|(x, _)| **x >= top);
    let mut below = behind.filter(|(_, y)| **y < level);
    below.next().map(|(x, _)| *x)
}

/// Integral by the trapezoidal rule.
pub(super) fn integral(x: &[f64], y: &[f64]) -> f64 {
    let pairs = x.windows(2).zip(y.windows(2));
    pairs
        .map(|(x, y)| 0.5 * (y[0] + y[1]) * (x[1] - x[0]))
        .sum()
}

/// Largest von Mises stress of an element \[Pa\].
pub(super) fn largest_von_mises(run: &Ran, state: &State) -> f64 {
    let fields = Fields::new(&run.built, state);
    let frame = fields.frame(&run.built, state);
    let stress = frame.cell_scalar("von_mises").unwrap_or_default();
    stress.iter().copied().fold(0.0, f64::max)
}

/// A number with `digits` that count, as text.
pub(crate) fn digits(value: f64, digits: usize) -> String {
    if value.is_nan() {
        return "-".to_owned();
    }
    if value == 0.0 || value.is_infinite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-3..6).contains(&magnitude) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    format!("{value:.decimals$}")
}

/// A time as milliseconds, or that it does not come.
pub(super) fn milliseconds(time: Option<f64>) -> String {
    time.map_or("-".to_owned(), |t| digits(1e3 * t, 3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hump_has_its_numbers() {
        let x = [0.0, 1.0, 2.0, 3.0, 4.0];
        let y = [0.0, 0.5, f64::NAN, 2.0, 0.1];
        assert_eq!(peak(&x, &y), (3.0, 2.0));
        assert_eq!(first_above(&x, &y, 0.4), Some(1.0));
        assert_eq!(first_below_after_peak(&x, &y, 0.2), Some(4.0));
        assert_eq!(first_below_after_peak(&x, &y, 0.05), None);
        assert_eq!(integral(&x[..2], &y[..2]), 0.25);
    }

    #[test]
    fn numbers_keep_their_digits() {
        assert_eq!(digits(0.012345, 3), "0.0123");
        assert_eq!(digits(1234.5, 2), "1234");
        assert_eq!(digits(1.234e-7, 3), "1.23e-7");
        assert_eq!(milliseconds(Some(0.0075)), "7.50");
    }
}
