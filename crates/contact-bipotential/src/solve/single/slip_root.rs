//! The scalar equation of a sliding contact.

/// Newton steps and halvings at most: 80 halvings of the exponent cross the whole range of numbers.
const STEPS: usize = 80;
/// Change of the root that is rounding \[-\].
const ROUNDED: f64 = 1e-15;
/// Where the lower end is zero the root is looked for five binary places below the upper one.
const FIVE_PLACES: f64 = 0.03125;

/// `G(a) = k0 + k1 a + k2 a^2 - |p + a c|`, whose root is the ratio of sliding velocity to friction force.
pub(super) struct SlipRoot {
    pub(super) p: [f64; 2],
    pub(super) c: [f64; 2],
    pub(super) k0: f64,
    pub(super) k1: f64,
    pub(super) k2: f64,
}

impl SlipRoot {
    #[inline]
    fn value_and_slope(&self, a: f64) -> (f64, f64) {
        let v = [self.p[0] + a * self.c[0], self.p[1] + a * self.c[1]];
        let length = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let value = self.k0 + a * (self.k1 + a * self.k2) - length;
        let slope = if length > 0.0 {
            (v[0] * self.c[0] + v[1] * self.c[1]) / length
        } else {
            0.0
        };
        (value, self.k1 + 2.0 * a * self.k2 - slope)
    }

    /// Where `k0 + k1 a + k2 a^2 = |p| + a |c|`: there `G >= 0`.
    #[inline]
    fn upper_bound(&self) -> f64 {
        let size = |v: &[f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
        let (h, q0) = (0.5 * (self.k1 - size(&self.c)), self.k0 - size(&self.p));
        let root = (h * h - self.k2 * q0).max(0.0).sqrt();
        // The form without cancellation for either sign of h.
        if h <= 0.0 {
            (root - h) / self.k2
        } else {
            -q0 / (h + root)
        }
    }

    #[inline]
    pub(super) fn find(&self) -> f64 {
        let (mut low, mut high) = (0.0, self.upper_bound());
        let usable = high > 0.0 && high.is_finite();
        if !usable {
            return 0.0;
        }
        let mut a = high;
        for _ in 0..STEPS {
            let (value, slope) = self.value_and_slope(a);
            if value == 0.0 {
                break;
            }
            if value > 0.0 {
                high = a;
            } else {
                low = a;
            }
            let mut next = a - value / slope;
            if !(next > low && next < high) {
                // The root may be many decades below the bound: halve the exponent where both ends allow it.
                next = if low > 0.0 {
                    (low * high).sqrt()
                } else {
                    FIVE_PLACES * high
                };
                if !(next > low && next < high) {
                    break;
                }
            }
            let done = (next - a).abs() <= ROUNDED * a;
            a = next;
            if done {
                break;
            }
        }
        a
    }
}
