//! Oblique impact of an elastic body with a spherical contact on a rigid one: Maw, Barber and Fawcett 1976.
//!
//! Mass `m`, radius of the sphere `R` and `E*` are 1, and the deepest approach is 1 too: no result depends on them.

/// What is known of the body and of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oblique {
    /// Poisson's ratio \[-\].
    pub nu: f64,
    /// `1 + m h^2 / I` with the lever `h` of the contact about the centre of mass \[-\]; 7/2 for a sphere.
    pub mobility: f64,
}

/// After an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound {
    /// Tangential velocity of the point of contact, as `psi` \[-\].
    pub psi: f64,
    /// Energy lost in friction over `mu^2 m V_n^2` \[-\].
    pub loss: f64,
}

impl Oblique {
    /// Ratio of the tangential to the normal frequency, squared: `K (1 - nu)/(2 - nu)` \[-\].
    pub fn chi(&self) -> f64 {
        self.mobility * (1.0 - self.nu) / (2.0 - self.nu)
    }

    /// `psi = 2 (1 - nu) V_t / (mu (2 - nu) V_n)` \[-\].
    pub fn psi(&self, mu: f64, tangential: f64, normal: f64) -> f64 {
        self.stiffness_ratio() * tangential / (mu * normal)
    }

    /// Slides throughout: `psi - 4 chi`, for `psi >= 4 chi - 1`.
    pub fn sliding(&self, psi: f64) -> f64 {
        psi - 4.0 * self.chi()
    }

    /// The rebound for any `psi >= 0`, computed with independent springs (Popov's reduction of dimension, which is
    /// exact for a contact without coupling of normal and tangential motion, as the theory assumes): a row of springs
    /// under the profile `x^2`, normal stiffness 1 and tangential `2 (1 - nu)/(2 - nu)` a length, each with its own
    /// Coulomb friction.
    pub fn rebound(&self, psi: f64) -> Rebound {
        const SPRINGS: usize = 400;
        const STEPS: f64 = 4000.0;
        let (ratio, dx) = (self.stiffness_ratio(), 1.01 / SPRINGS as f64);
        // The energy of the deepest approach; the contact lasts 2.94 / V_n.
        let normal = (16.0_f64 / 15.0).sqrt();
        let dt = 2.94 / normal / STEPS;
        let profile: Vec<f64> = (0..SPRINGS)
            .map(|k| ((k as f64 + 0.5) * dx).powi(2))
            .collect();
        let mut force = vec![0.0_f64; SPRINGS];
        // Friction coefficient 1: it only scales what is tangential.
        let (mut depth, mut approach, mut slip) = (0.0_f64, normal, psi * normal / ratio);
        let start = slip;
        let mut pull = [0.0; 2];
        loop {
            approach -= 0.5 * dt * pull[0];
            slip -= 0.5 * dt * self.mobility * pull[1];
            depth += dt * approach;
            for (f, x2) in force.iter_mut().zip(&profile) {
                let bound = 2.0 * dx * (depth - x2).max(0.0);
                *f = (*f + 2.0 * ratio * dx * dt * slip).clamp(-bound, bound);
            }
            pull = [4.0 / 3.0 * depth.max(0.0).powf(1.5), force.iter().sum()];
            approach -= 0.5 * dt * pull[0];
            slip -= 0.5 * dt * self.mobility * pull[1];
            if depth <= 0.0 {
                break;
            }
        }
        Rebound {
            psi: ratio * slip / normal,
            loss: 0.5 * (start * start - slip * slip) / (self.mobility * normal * normal),
        }
    }

    /// Tangential over normal stiffness of the contact.
    fn stiffness_ratio(&self) -> f64 {
        2.0 * (1.0 - self.nu) / (2.0 - self.nu)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: Oblique = Oblique {
        nu: 0.3,
        mobility: 3.5,
    };

    #[test]
    fn springs_that_slide_throughout_follow_the_closed_form() {
        let first = 4.0 * SPHERE.chi() - 1.0;
        for psi in [first, first + 0.5, first + 3.0] {
            let rebound = SPHERE.rebound(psi);
            assert!(
                (rebound.psi - SPHERE.sliding(psi)).abs() < 2e-3,
                "{psi}: {rebound:?}"
            );
        }
        // Below, friction is less than all it could be.
        assert!(SPHERE.rebound(0.7 * first).psi > SPHERE.sliding(0.7 * first) + 0.1);
    }

    #[test]
    fn the_curve_has_its_shape() {
        let psi = |x: f64| SPHERE.rebound(x).psi;
        // A light touch still rolls on a little, a harder one is thrown back, hardest between.
        assert!(
            psi(1.0) < 0.0 && psi(2.0) < psi(1.0) && psi(3.5) < psi(3.0) && psi(5.0) > psi(4.0)
        );
        let loss = SPHERE.rebound(2.0).loss;
        assert!(loss > 0.0);
        // Work of friction in gross sliding: the mean slip times the impulse 2 mu m V_n.
        let (slides, ratio) = (SPHERE.rebound(6.0), 1.4 / 1.7);
        let exact = (6.0 + SPHERE.sliding(6.0)) / ratio;
        assert!(
            (slides.loss - exact).abs() < 2e-3 * exact,
            "{slides:?} {exact}"
        );
    }
}
