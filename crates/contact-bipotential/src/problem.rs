//! The frictional contact problem without a mesh.

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::error::ContactError;

/// Find `r` with `u = W r + q`, `r` in `K`, `u + mu |u_t| n` in `K*`, orthogonal.
///
/// Flat vectors hold `cone.dim()` entries a contact, normal last; `r_n >= 0` is compression, `u_n >= 0` separation.
/// `u` may be a gap \[m\] with `r` a force, or a velocity with `r` an impulse: the solvers know no unit.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ContactProblem {
    /// Delassus matrix, unit of `u` over unit of `r`.
    pub w: Delassus,
    /// What `u` would be without reactions.
    pub q: Vec<f64>,
    /// Friction coefficient of each contact \[-\].
    pub mu: Vec<f64>,
    /// Entries a contact.
    pub cone: Cone,
}

impl ContactProblem {
    /// A checked problem.
    ///
    /// # Errors
    /// Those of [`Self::check`].
    pub fn new(w: Delassus, q: Vec<f64>, mu: Vec<f64>, cone: Cone) -> Result<Self, ContactError> {
        let problem = Self::unchecked(w, q, mu, cone);
        problem.check()?;
        Ok(problem)
    }

    /// The same without the checks, which [`solve`](crate::solve) makes anyway.
    #[must_use]
    pub fn unchecked(w: Delassus, q: Vec<f64>, mu: Vec<f64>, cone: Cone) -> Self {
        ContactProblem { w, q, mu, cone }
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.mu.len()
    }

    /// Checks lengths, finiteness and bounds.
    ///
    /// # Errors
    /// [`ContactError`] naming the array and the entry.
    pub fn check(&self) -> Result<(), ContactError> {
        let contacts = self.contacts();
        let expected = contacts * self.cone.dim();
        self.check_lengths(contacts, expected)?;
        self.check_numbers()?;
        for (contact, &mu) in self.mu.iter().enumerate() {
            if !(mu >= 0.0 && mu.is_finite()) {
                return Err(ContactError::Friction { contact, mu });
            }
            let value = self.normal_compliance(contact);
            if value < 0.0 || value.is_nan() {
                return Err(ContactError::Compliance { contact, value });
            }
        }
        Ok(())
    }

    fn check_lengths(&self, contacts: usize, expected: usize) -> Result<(), ContactError> {
        let length = |what, found| {
            if found == expected {
                Ok(())
            } else {
                Err(ContactError::Length {
                    what,
                    contacts,
                    found,
                    expected,
                })
            }
        };
        length("q", self.q.len())?;
        length("W", self.w.size())?;
        match &self.w {
            Delassus::Dense(w) => length("W (columns)", w.ncols()),
            Delassus::BlockSparse(w) if w.dim() != self.cone.dim() => {
                let (found, expected) = (w.dim(), self.cone.dim());
                Err(ContactError::Length {
                    what: "row of a block of W",
                    contacts,
                    found,
                    expected,
                })
            }
            _ => Ok(()),
        }
    }

    fn check_numbers(&self) -> Result<(), ContactError> {
        let cone = self.cone;
        let bad = |what, entry: usize, contact, value| {
            Err(ContactError::NotFinite {
                what,
                contact,
                entry,
                value,
            })
        };
        if let Some((k, &x)) = first_bad(&self.q) {
            return bad("q", k, cone.contact(k), x);
        }
        match &self.w {
            Delassus::Dense(w) => {
                for j in 0..w.ncols() {
                    if let Some((i, &x)) = first_bad(w.col_as_slice(j)) {
                        return bad("W", i * w.ncols() + j, cone.contact(i), x);
                    }
                }
            }
            Delassus::BlockSparse(w) => {
                for c in 0..w.contacts() {
                    if let Some((k, &x)) = first_bad(w.row_values(c)) {
                        return bad("W", k, c, x);
                    }
                }
            }
            Delassus::Operator(_) => {}
        }
        Ok(())
    }

    fn normal_compliance(&self, c: usize) -> f64 {
        match self.cone {
            Cone::Frictionless => self.w.diagonal::<1>(c)[(0, 0)],
            Cone::Planar => self.w.diagonal::<2>(c)[(1, 1)],
            Cone::Spatial => self.w.diagonal::<3>(c)[(2, 2)],
        }
    }

    /// Compliance scale of each contact: mean diagonal of `W_cc`; where that vanishes, the mean over the others (or 1).
    #[must_use]
    pub(crate) fn compliance_scales(&self) -> Vec<f64> {
        let mut scales: Vec<f64> = (0..self.contacts())
            .map(|c| match self.cone {
                Cone::Frictionless => self.w.diagonal::<1>(c).trace(),
                Cone::Planar => self.w.diagonal::<2>(c).trace() / 2.0,
                Cone::Spatial => self.w.diagonal::<3>(c).trace() / 3.0,
            })
            .collect();
        let good = |x: f64| x > 0.0 && x.is_finite();
        let (sum, count) = scales
            .iter()
            .filter(|x| good(**x))
            .fold((0.0, 0usize), |(s, n), x| (s + x, n + 1));
        let mean = if count > 0 { sum / count as f64 } else { 1.0 };
        for x in &mut scales {
            if !good(*x) {
                *x = mean;
            }
        }
        scales
    }
}

fn first_bad(values: &[f64]) -> Option<(usize, &f64)> {
    // A finite sum proves all terms finite, and it vectorises; only a bad one is worth a search.
    let zero: f64 = values.iter().map(|x| x * 0.0).sum();
    if zero == 0.0 {
        return None;
    }
    values.iter().enumerate().find(|(_, x)| !x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;

    fn unit(contacts: usize) -> ContactProblem {
        let n = 3 * contacts;
        ContactProblem {
            w: Delassus::Dense(Mat::identity(n, n)),
            q: vec![0.0; n],
            mu: vec![0.3; contacts],
            cone: Cone::Spatial,
        }
    }

    #[test]
    fn wrong_data_is_named() {
        assert!(unit(2).check().is_ok());
        let mut p = unit(2);
        p.q[4] = f64::NAN;
        assert!(
            p.check()
                .unwrap_err()
                .to_string()
                .contains("entry 4 (contact 1)")
        );
        let mut p = unit(2);
        p.mu[1] = -0.1;
        assert_eq!(
            p.check(),
            Err(ContactError::Friction {
                contact: 1,
                mu: -0.1
            })
        );
        let mut p = unit(2);
        p.q.pop();
        assert!(matches!(
            p.check(),
            Err(ContactError::Length {
                what: "q",
                found: 5,
                expected: 6,
                ..
            })
        ));
        let mut w = Mat::identity(6, 6);
        w[(5, 5)] = -1.0;
        let p = ContactProblem {
            w: Delassus::Dense(w),
            ..unit(2)
        };
        assert_eq!(
            p.check(),
            Err(ContactError::Compliance {
                contact: 1,
                value: -1.0
            })
        );
        let mut w = Mat::identity(6, 6);
        w[(5, 0)] = f64::INFINITY;
        let p = ContactProblem {
            w: Delassus::Dense(w),
            ..unit(2)
        };
        assert!(matches!(
            p.check(),
            Err(ContactError::NotFinite {
                what: "W",
                contact: 1,
                ..
            })
        ));
    }
}
