//! Materials.

use hyperelastic::{ElasticConstants, ParameterError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A law and a density.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Stored energy.
    pub law: Law,
    /// Mass per reference volume \[kg/m^3\].
    pub density: f64,
}

/// Hyperelastic laws. Where `E`, `nu`, `G`, `K`, `lambda` are offered, exactly two of them are given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Law {
    /// Linear in the Green-Lagrange strain: small strains, large rotations.
    #[allow(non_snake_case)]
    SaintVenantKirchhoff {
        /// Young's modulus \[Pa\].
        #[serde(default)]
        E: Option<f64>,
        /// Poisson's ratio \[-\].
        #[serde(default)]
        nu: Option<f64>,
        /// Shear modulus \[Pa\].
        #[serde(default)]
        G: Option<f64>,
        /// Bulk modulus \[Pa\].
        #[serde(default)]
        K: Option<f64>,
        /// First Lame constant \[Pa\].
        #[serde(default)]
        lambda: Option<f64>,
    },
    /// Energy of fourth order in the Green-Lagrange strain [Feng2007, eq. 16]: `z = tr(E)/sqrt 3` is the change of
    /// volume, `q = tr(E_d^2)` the shear.
    #[allow(non_snake_case)]
    ThreeE {
        /// Initial shear modulus \[Pa\].
        G: f64,
        /// Initial bulk modulus \[Pa\].
        K: f64,
        /// Factor of the third invariant of the deviator, `sqrt(6) a1 det(E_d)` \[Pa\].
        #[serde(default)]
        a1: f64,
        /// Factor of the third power of the change of volume, `a2/3 z^3` \[Pa\].
        #[serde(default)]
        a2: f64,
        /// Factor of the coupling of volume and shear, `a3/4 z^2 q` \[Pa\].
        #[serde(default)]
        a3: f64,
        /// Factor of the fourth power of the change of volume, `a4/4 z^4` \[Pa\].
        #[serde(default)]
        a4: f64,
        /// Factor of the fourth power of the shear, `a5/4 q^2` \[Pa\].
        #[serde(default)]
        a5: f64,
    },
    /// Foam-like law, nu = 1/4 [Hu2022, eq. 37].
    #[allow(non_snake_case)]
    BlatzKo {
        /// Shear modulus \[Pa\].
        G: f64,
    },
    /// Compressible neo-Hookean, `W = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2`.
    #[allow(non_snake_case)]
    NeoHookean {
        /// Young's modulus \[Pa\].
        #[serde(default)]
        E: Option<f64>,
        /// Poisson's ratio \[-\].
        #[serde(default)]
        nu: Option<f64>,
        /// Shear modulus \[Pa\].
        #[serde(default)]
        G: Option<f64>,
        /// Bulk modulus \[Pa\].
        #[serde(default)]
        K: Option<f64>,
        /// First Lame constant \[Pa\].
        #[serde(default)]
        lambda: Option<f64>,
    },
}

/// A law of the material library, ready to use.
#[derive(Clone, Debug)]
pub enum BuiltLaw {
    /// See [`Law::SaintVenantKirchhoff`].
    SaintVenantKirchhoff(hyperelastic::SaintVenantKirchhoff),
    /// See [`Law::ThreeE`].
    ThreeE(hyperelastic::ThreeE),
    /// See [`Law::BlatzKo`].
    BlatzKo(hyperelastic::BlatzKo),
    /// See [`Law::NeoHookean`].
    NeoHookean(hyperelastic::NeoHookean),
}

/// Why a law cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{message}")]
pub struct LawError {
    /// Field of the law that is to blame; empty for the law as a whole.
    pub field: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

impl Law {
    /// The law of the material library.
    ///
    /// # Errors
    /// Not exactly two elastic constants, or a parameter outside its physical bounds.
    #[allow(non_snake_case)]
    pub fn build(&self) -> Result<BuiltLaw, LawError> {
        let built = match *self {
            Law::SaintVenantKirchhoff { .. } => self.elastic_constants().and_then(|elastic| {
                hyperelastic::SaintVenantKirchhoff::new(elastic)
                    .map(BuiltLaw::SaintVenantKirchhoff)
                    .map_err(LawError::from)
            }),
            Law::ThreeE {
                a1, a2, a3, a4, a5, ..
            } => self.elastic_constants().and_then(|elastic| {
                hyperelastic::ThreeE::new(elastic, [a1, a2, a3, a4, a5])
                    .map(BuiltLaw::ThreeE)
                    .map_err(LawError::from)
            }),
            Law::BlatzKo { G } => hyperelastic::BlatzKo::new(G)
                .map(BuiltLaw::BlatzKo)
                .map_err(LawError::from),
            Law::NeoHookean { .. } => self.elastic_constants().and_then(|elastic| {
                hyperelastic::NeoHookean::new(elastic)
                    .map(BuiltLaw::NeoHookean)
                    .map_err(LawError::from)
            }),
        };
        built.map_err(|error| self.blame(error))
    }

    /// Elastic constants at the unstrained state.
    ///
    /// # Errors
    /// As [`Law::build`].
    #[allow(non_snake_case)]
    pub fn elastic_constants(&self) -> Result<ElasticConstants, LawError> {
        let elastic = match *self {
            Law::ThreeE { G, K, .. } => ElasticConstants::from_shear_bulk(G, K),
            Law::BlatzKo { G } => ElasticConstants::from_shear_lame(G, G),
            Law::SaintVenantKirchhoff {
                E,
                nu,
                G,
                K,
                lambda,
            }
            | Law::NeoHookean {
                E,
                nu,
                G,
                K,
                lambda,
            } => match (E, nu, G, K, lambda) {
                (Some(E), Some(nu), None, None, None) => {
                    ElasticConstants::from_young_poisson(E, nu)
                }
                (Some(E), None, Some(G), None, None) => ElasticConstants::from_young_shear(E, G),
                (None, Some(nu), Some(G), None, None) => {
                    ElasticConstants::from_shear_poisson(G, nu)
                }
                (None, Some(nu), None, Some(K), None) => ElasticConstants::from_bulk_poisson(K, nu),
                (None, None, Some(G), Some(K), None) => ElasticConstants::from_shear_bulk(G, K),
                (None, None, Some(G), None, Some(lambda)) => {
                    ElasticConstants::from_shear_lame(G, lambda)
                }
                _ => {
                    return Err(LawError {
                        field: String::new(),
                        message: PAIRS.into(),
                    });
                }
            },
        };
        elastic.map_err(LawError::from)
    }

    /// Keeps the field of an error only if the scene gives it; a bound on what follows from other constants is a
    /// matter of the whole law.
    #[allow(non_snake_case)]
    fn blame(&self, error: LawError) -> LawError {
        let given = match self {
            Law::ThreeE { .. } | Law::BlatzKo { .. } => true,
            Law::SaintVenantKirchhoff {
                E,
                nu,
                G,
                K,
                lambda,
            }
            | Law::NeoHookean {
                E,
                nu,
                G,
                K,
                lambda,
            } => match error.field.as_str() {
                "E" => E.is_some(),
                "nu" => nu.is_some(),
                "G" => G.is_some(),
                "K" => K.is_some(),
                "lambda" => lambda.is_some(),
                _ => false,
            },
        };
        let field = if given { error.field } else { String::new() };
        LawError { field, ..error }
    }
}

const PAIRS: &str =
    "needs exactly two elastic constants: (E, nu), (E, G), (nu, G), (nu, K), (G, K) or (G, lambda)";

impl From<ParameterError> for LawError {
    fn from(error: ParameterError) -> Self {
        let (ParameterError::NotFinite { parameter, .. }
        | ParameterError::OutsideOpen { parameter, .. }
        | ParameterError::OutsideClosed { parameter, .. }) = error;
        // The letter of a parameter is the last word of its name: "shear modulus G".
        let field = parameter.rsplit(' ').next().unwrap_or(parameter);
        LawError {
            field: field.to_owned(),
            message: error.to_string(),
        }
    }
}
