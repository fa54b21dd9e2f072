//! Isotropic linear elasticity: one pair of constants from any other.

use crate::parameter::{ParameterError, finite, inside_open};

const STABLE: &str = "a natural state is stable only with a positive modulus";
const POISSON: &str = "outside -1 < nu < 1/2 a modulus is negative; nu = 1/2 is incompressible: approach it, e.g. with 0.495";

/// The two constants of isotropic linear elasticity, all pairs of which determine each other.
///
/// Both moduli are positive: `G > 0`, `K > 0`, hence `-1 < nu < 1/2`.
///
/// ```
/// use hyperelastic::ElasticConstants;
///
/// let rubber = ElasticConstants::from_young_poisson(10.0e6, 0.495)?;
/// assert!((rubber.shear_modulus() - 3.344e6).abs() < 1.0e3);
/// assert!(ElasticConstants::from_young_poisson(10.0e6, 0.5).is_err());
/// # Ok::<(), hyperelastic::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticConstants {
    shear: f64,
    bulk: f64,
    // Kept beside the other two: from (E, 0) it is exactly zero, K - 2G/3 is not.
    lame: f64,
}

impl ElasticConstants {
    /// From the shear modulus `G` and the bulk modulus `K` \[Pa\].
    ///
    /// # Errors
    /// Unless `G > 0` and `K > 0`, both finite.
    pub fn from_shear_bulk(shear: f64, bulk: f64) -> Result<Self, ParameterError> {
        Self {
            shear,
            bulk,
            lame: bulk - 2.0 * shear / 3.0,
        }
        .checked()
    }

    /// From the shear modulus `G` and Lame's first constant `lambda` \[Pa\].
    ///
    /// # Errors
    /// Unless `G > 0` and `K = lambda + 2G/3 > 0`, both finite.
    pub fn from_shear_lame(shear: f64, lame: f64) -> Result<Self, ParameterError> {
        finite("Lame's lambda", lame)?;
        Self {
            shear,
            bulk: lame + 2.0 * shear / 3.0,
            lame,
        }
        .checked()
    }

    /// From Young's modulus `E` \[Pa\] and Poisson's ratio `nu`.
    ///
    /// # Errors
    /// Unless `E > 0` and `-1 < nu < 1/2`, both finite.
    pub fn from_young_poisson(young: f64, nu: f64) -> Result<Self, ParameterError> {
        inside_open("Young's modulus E", young, [0.0, f64::INFINITY], STABLE)?;
        inside_open("Poisson's ratio nu", nu, [-1.0, 0.5], POISSON)?;
        let shear = young / (2.0 * (1.0 + nu));
        let bulk = young / (3.0 * (1.0 - 2.0 * nu));
        Self {
            shear,
            bulk,
            lame: 2.0 * shear * nu / (1.0 - 2.0 * nu),
        }
        .checked()
    }

    /// From the shear modulus `G` \[Pa\] and Poisson's ratio `nu`.
    ///
    /// # Errors
    /// Unless `G > 0` and `-1 < nu < 1/2`, both finite.
    pub fn from_shear_poisson(shear: f64, nu: f64) -> Result<Self, ParameterError> {
        inside_open("Poisson's ratio nu", nu, [-1.0, 0.5], POISSON)?;
        let bulk = 2.0 * shear * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
        Self {
            shear,
            bulk,
            lame: 2.0 * shear * nu / (1.0 - 2.0 * nu),
        }
        .checked()
    }

    /// From the bulk modulus `K` \[Pa\] and Poisson's ratio `nu`.
    ///
    /// # Errors
    /// Unless `K > 0` and `-1 < nu < 1/2`, both finite.
    pub fn from_bulk_poisson(bulk: f64, nu: f64) -> Result<Self, ParameterError> {
        inside_open("Poisson's ratio nu", nu, [-1.0, 0.5], POISSON)?;
        let shear = 3.0 * bulk * (1.0 - 2.0 * nu) / (2.0 * (1.0 + nu));
        Self {
            shear,
            bulk,
            lame: 3.0 * bulk * nu / (1.0 + nu),
        }
        .checked()
    }

    /// From Young's modulus `E` and the shear modulus `G` \[Pa\].
    ///
    /// # Errors
    /// Unless `G > 0` and `0 < E < 3G`, both finite.
    pub fn from_young_shear(young: f64, shear: f64) -> Result<Self, ParameterError> {
        inside_open("shear modulus G", shear, [0.0, f64::INFINITY], STABLE)?;
        let reason = "E = 3G is incompressible, nu = E/(2G) - 1 = 1/2";
        inside_open("Young's modulus E", young, [0.0, 3.0 * shear], reason)?;
        let compliance = 3.0 * shear - young;
        let bulk = young * shear / (3.0 * compliance);
        Self {
            shear,
            bulk,
            lame: shear * (young - 2.0 * shear) / compliance,
        }
        .checked()
    }

    fn checked(self) -> Result<Self, ParameterError> {
        inside_open("shear modulus G", self.shear, [0.0, f64::INFINITY], STABLE)?;
        inside_open("bulk modulus K", self.bulk, [0.0, f64::INFINITY], STABLE)?;
        Ok(self)
    }

    /// Shear modulus `G` \[Pa\].
    #[inline]
    pub fn shear_modulus(&self) -> f64 {
        self.shear
    }

    /// Bulk modulus `K` \[Pa\].
    #[inline]
    pub fn bulk_modulus(&self) -> f64 {
        self.bulk
    }

    /// Lame's first constant `lambda = K - 2G/3` \[Pa\].
    #[inline]
    pub fn lame_modulus(&self) -> f64 {
        self.lame
    }

    /// Young's modulus `E` \[Pa\].
    #[must_use]
    pub fn young_modulus(&self) -> f64 {
        9.0 * self.bulk * self.shear / (3.0 * self.bulk + self.shear)
    }

    /// Poisson's ratio `nu`.
    #[must_use]
    pub fn poisson_ratio(&self) -> f64 {
        self.lame / (3.0 * self.bulk - self.lame)
    }

    /// Modulus of uniaxial strain `M = lambda + 2G` \[Pa\]: pressure waves run at `sqrt(M/rho)`, shear waves at
    /// `sqrt(G/rho)`.
    #[must_use]
    pub fn p_wave_modulus(&self) -> f64 {
        self.lame + 2.0 * self.shear
    }

    /// Modulus of contact with a rigid body `E* = E/(1 - nu^2)` \[Pa\].
    #[must_use]
    pub fn contact_modulus(&self) -> f64 {
        let nu = self.poisson_ratio();
        self.young_modulus() / (1.0 - nu * nu)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn zero_poisson_ratio_is_exact() {
        let constants = ElasticConstants::from_young_poisson(1.0e4, 0.0).unwrap();
        assert_eq!(constants.lame_modulus(), 0.0);
        assert_eq!(constants.shear_modulus(), 5.0e3);
        assert_eq!(constants.poisson_ratio(), 0.0);
        assert_eq!(constants.p_wave_modulus(), 1.0e4);
    }

    #[test]
    fn refusals_name_parameter_value_and_bound() {
        let message = ElasticConstants::from_young_poisson(1.0, 0.5)
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("nu = 0.5") && message.contains("-1 and 0.5"),
            "{message}"
        );
        let message = ElasticConstants::from_shear_bulk(-3.0, 1.0)
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("G = -3") && message.contains("0 and inf"),
            "{message}"
        );
    }

    #[test]
    fn refuses_what_cannot_be() {
        let infinity = f64::INFINITY;
        for (a, b) in [
            (0.0, 1.0),
            (1.0, 0.0),
            (-1.0, 1.0),
            (1.0, -1.0),
            (f64::NAN, 1.0),
            (1.0, infinity),
        ] {
            assert!(
                ElasticConstants::from_shear_bulk(a, b).is_err(),
                "G = {a}, K = {b}"
            );
        }
        for (a, b) in [
            (0.0, 0.3),
            (1.0, 0.5),
            (1.0, -1.0),
            (1.0, 0.7),
            (infinity, 0.3),
            (1.0, f64::NAN),
        ] {
            assert!(
                ElasticConstants::from_young_poisson(a, b).is_err(),
                "E = {a}, nu = {b}"
            );
            assert!(
                ElasticConstants::from_shear_poisson(a, b).is_err(),
                "G = {a}, nu = {b}"
            );
            assert!(
                ElasticConstants::from_bulk_poisson(a, b).is_err(),
                "K = {a}, nu = {b}"
            );
        }
        for (a, b) in [(1.0, -0.67), (0.0, 1.0), (1.0, f64::NAN), (f64::NAN, 1.0)] {
            assert!(
                ElasticConstants::from_shear_lame(a, b).is_err(),
                "G = {a}, lambda = {b}"
            );
        }
        for (a, b) in [
            (3.0, 1.0),
            (0.0, 1.0),
            (1.0, 0.0),
            (-1.0, -1.0),
            (1.0, f64::NAN),
        ] {
            assert!(
                ElasticConstants::from_young_shear(a, b).is_err(),
                "E = {a}, G = {b}"
            );
        }
    }

    proptest! {
        #[test]
        fn every_pair_gives_the_same_constants(young in 1e-3..1e12, nu in -0.9..0.49) {
            let given = ElasticConstants::from_young_poisson(young, nu).unwrap();
            let (shear, bulk, lame) = (given.shear_modulus(), given.bulk_modulus(), given.lame_modulus());
            for other in [
                ElasticConstants::from_shear_bulk(shear, bulk),
                ElasticConstants::from_shear_lame(shear, lame),
                ElasticConstants::from_shear_poisson(shear, nu),
                ElasticConstants::from_bulk_poisson(bulk, nu),
                ElasticConstants::from_young_shear(young, shear),
            ] {
                let other = other.unwrap();
                assert_relative_eq!(other.young_modulus(), young, max_relative = 1e-11);
                assert_relative_eq!(other.poisson_ratio(), nu, max_relative = 1e-11, epsilon = 1e-11);
                assert_relative_eq!(other.shear_modulus(), shear, max_relative = 1e-11);
                assert_relative_eq!(other.bulk_modulus(), bulk, max_relative = 1e-11);
                assert_relative_eq!(other.lame_modulus(), lame, max_relative = 1e-11, epsilon = 1e-11 * bulk);
            }
        }

        #[test]
        fn derived_moduli_are_those_of_the_textbook(young in 1e-3..1e12, nu in -0.9..0.49) {
            let given = ElasticConstants::from_young_poisson(young, nu).unwrap();
            let p_wave = young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
            assert_relative_eq!(given.p_wave_modulus(), p_wave, max_relative = 1e-12);
            assert_relative_eq!(given.contact_modulus(), young / (1.0 - nu * nu), max_relative = 1e-11);
        }
    }
}
