//! Numbers of a curve that the grid of the steps does not quantise.

/// Times, increasing, and values.
pub type Curve = Vec<(f64, f64)>;

/// Time and value of the largest value, on the parabola through it and its neighbours.
pub fn peak(curve: &[(f64, f64)]) -> Option<(f64, f64)> {
    let largest = |best: usize, k: usize| if curve[k].1 > curve[best].1 { k } else { best };
    let k = (0..curve.len()).reduce(largest)?;
    let Some(&[a, b, c]) = k.checked_sub(1).and_then(|first| curve.get(first..k + 2)) else {
        return curve.get(k).copied();
    };
    let (left, right) = (slope(a, b), slope(b, c));
    let bend = (right - left) / (c.0 - a.0);
    if bend >= 0.0 {
        return Some(b);
    }
    let at_b = left + bend * (b.0 - a.0);
    Some((b.0 - 0.5 * at_b / bend, b.1 - 0.25 * at_b * at_b / bend))
}

/// When the curve last falls below a level, on the line between two steps.
pub fn falls_below(curve: &[(f64, f64)], level: f64) -> Option<f64> {
    let pair = curve
        .windows(2)
        .rfind(|p| p[0].1 >= level && p[1].1 < level)?;
    Some(pair[0].0 + (level - pair[0].1) / slope(pair[0], pair[1]))
}

/// Mean between the first and the last time.
pub fn mean(curve: &[(f64, f64)]) -> Option<f64> {
    let span = curve.last()?.0 - curve.first()?.0;
    let area = curve
        .windows(2)
        .map(|p| 0.5 * (p[0].1 + p[1].1) * (p[1].0 - p[0].0));
    Some(area.sum::<f64>() / span)
}

fn slope(a: (f64, f64), b: (f64, f64)) -> f64 {
    (b.1 - a.1) / (b.0 - a.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_parabola_are_exact() {
        let y = |t: f64| 3.0 - (t - 0.37).powi(2);
        let curve: Curve = [0.0, 0.2, 0.5, 0.6, 1.0].map(|t| (t, y(t))).to_vec();
        let (t, top) = peak(&curve).unwrap();
        assert!((t - 0.37).abs() < 1e-12 && (top - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_peak_at_the_end_is_the_last_value() {
        assert_eq!(peak(&[(0.0, 0.0), (1.0, 2.0)]), Some((1.0, 2.0)));
        assert_eq!(peak(&[]), None);
    }

    #[test]
    fn lines_are_crossed_where_they_are() {
        let curve = [(0.0, 1.0), (1.0, 2.0), (3.0, 0.0), (4.0, 0.0)];
        assert_eq!(falls_below(&curve, 0.5), Some(2.5));
        assert_eq!(falls_below(&curve, 2.5), None);
        assert_eq!(mean(&curve), Some((1.5 + 2.0) / 4.0));
    }
}
