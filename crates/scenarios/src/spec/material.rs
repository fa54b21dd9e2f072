//! Materials.

use fe_core::{Block, Dilatation, FeError, ValidMesh, solid_block_with};
use hyperelastic::{ElasticConstants, ParameterError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::variants::struct_variants;

/// A law and a density.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Stored energy.
    pub law: Law,
    /// Mass per reference volume \[kg/m^3\].
    pub density: f64,
}

struct_variants! {
    /// Hyperelastic laws. A new one is a variant here, and an arm in `Law::build` and in [`Law::elastic_constants`].
    #[derive(Clone, Debug, PartialEq, Serialize)]
    pub enum Law {
        /// Linear in the Green-Lagrange strain: small strains, large rotations.
        SaintVenantKirchhoff(ElasticPair),
        /// Energy of fourth order in the Green-Lagrange strain [Feng2007, eq. 16]: `z = tr(E)/sqrt 3` is the change of
        /// volume, `q = tr(E_d^2)` the shear.
        ThreeE(ThreeEParameters),
        /// Foam-like law, nu = 1/4 [Hu2022, eq. 37].
        BlatzKo(BlatzKoParameters),
        /// Compressible neo-Hookean, `W = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2`.
        NeoHookean(ElasticPair),
    }
}

/// Elastic constants of which exactly two are given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ElasticPair {
    /// Young's modulus \[Pa\].
    #[serde(default)]
    pub E: Option<f64>,
    /// Poisson's ratio \[-\].
    #[serde(default)]
    pub nu: Option<f64>,
    /// Shear modulus \[Pa\].
    #[serde(default)]
    pub G: Option<f64>,
    /// Bulk modulus \[Pa\].
    #[serde(default)]
    pub K: Option<f64>,
    /// First Lame constant \[Pa\].
    #[serde(default)]
    pub lambda: Option<f64>,
}

/// Parameters of [`Law::ThreeE`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ThreeEParameters {
    /// Initial shear modulus \[Pa\].
    pub G: f64,
    /// Initial bulk modulus \[Pa\].
    pub K: f64,
    /// Factor of the third invariant of the deviator, `sqrt(6) a1 det(E_d)` \[Pa\].
    #[serde(default)]
    pub a1: f64,
    /// Factor of the third power of the change of volume, `a2/3 z^3` \[Pa\].
    #[serde(default)]
    pub a2: f64,
    /// Factor of the coupling of volume and shear, `a3/4 z^2 q` \[Pa\].
    #[serde(default)]
    pub a3: f64,
    /// Factor of the fourth power of the change of volume, `a4/4 z^4` \[Pa\].
    #[serde(default)]
    pub a4: f64,
    /// Factor of the fourth power of the shear, `a5/4 q^2` \[Pa\].
    #[serde(default)]
    pub a5: f64,
}

/// Parameter of [`Law::BlatzKo`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct BlatzKoParameters {
    /// Shear modulus \[Pa\].
    pub G: f64,
}

/// A law of the material library, whichever: it makes blocks of elements.
pub(crate) trait BuiltLaw {
    /// A block of the law on the block `index` of the mesh; `density` \[kg/m^3\].
    fn block(
        &self,
        mesh: &ValidMesh,
        index: usize,
        density: f64,
        dilatation: Dilatation,
    ) -> Result<Box<dyn Block>, FeError>;
}

impl<M: hyperelastic::Material> BuiltLaw for M {
    fn block(
        &self,
        mesh: &ValidMesh,
        index: usize,
        density: f64,
        dilatation: Dilatation,
    ) -> Result<Box<dyn Block>, FeError> {
        solid_block_with(mesh, index, self.clone(), density, dilatation)
    }
}

/// Why a law cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{message}")]
#[non_exhaustive]
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
    pub(crate) fn build(&self) -> Result<Box<dyn BuiltLaw>, LawError> {
        let built = self.elastic_constants().and_then(|elastic| match self {
            Law::SaintVenantKirchhoff(_) => built(hyperelastic::SaintVenantKirchhoff::new(elastic)),
            Law::ThreeE(law) => {
                let a = [law.a1, law.a2, law.a3, law.a4, law.a5];
                built(hyperelastic::ThreeE::new(elastic, a))
            }
            Law::BlatzKo(law) => built(hyperelastic::BlatzKo::new(law.G)),
            Law::NeoHookean(_) => built(hyperelastic::NeoHookean::new(elastic)),
        });
        built.map_err(|error| self.blame(error))
    }

    /// Elastic constants at the unstrained state.
    ///
    /// # Errors
    /// [`LawError`] unless exactly two constants are given, within their physical bounds.
    pub fn elastic_constants(&self) -> Result<ElasticConstants, LawError> {
        let elastic = match self {
            Law::SaintVenantKirchhoff(pair) | Law::NeoHookean(pair) => return pair.constants(),
            Law::ThreeE(law) => ElasticConstants::from_shear_bulk(law.G, law.K),
            Law::BlatzKo(law) => ElasticConstants::from_shear_lame(law.G, law.G),
        };
        elastic.map_err(LawError::from)
    }

    /// Keeps the field of an error only if the scene gives it; a bound on what follows from other constants is a
    /// matter of the whole law.
    fn blame(&self, error: LawError) -> LawError {
        let given = match self {
            Law::SaintVenantKirchhoff(pair) | Law::NeoHookean(pair) => pair.gives(&error.field),
            Law::ThreeE(_) | Law::BlatzKo(_) => true,
        };
        let field = if given { error.field } else { String::new() };
        LawError { field, ..error }
    }
}

fn built<M: hyperelastic::Material>(
    law: Result<M, ParameterError>,
) -> Result<Box<dyn BuiltLaw>, LawError> {
    Ok(Box::new(law?))
}

impl ElasticPair {
    /// Young's modulus `E` \[Pa\] and Poisson's ratio `nu` \[-\].
    #[must_use]
    pub fn young_poisson(young: f64, poisson: f64) -> ElasticPair {
        ElasticPair {
            E: Some(young),
            nu: Some(poisson),
            ..ElasticPair::default()
        }
    }

    #[allow(non_snake_case)]
    fn constants(&self) -> Result<ElasticConstants, LawError> {
        let ElasticPair {
            E,
            nu,
            G,
            K,
            lambda,
        } = *self;
        let elastic = match (E, nu, G, K, lambda) {
            (Some(E), Some(nu), None, None, None) => ElasticConstants::from_young_poisson(E, nu),
            (Some(E), None, Some(G), None, None) => ElasticConstants::from_young_shear(E, G),
            (None, Some(nu), Some(G), None, None) => ElasticConstants::from_shear_poisson(G, nu),
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
        };
        elastic.map_err(LawError::from)
    }

    /// True if the constant of this name is one of the given ones.
    fn gives(&self, field: &str) -> bool {
        match field {
            "E" => self.E.is_some(),
            "nu" => self.nu.is_some(),
            "G" => self.G.is_some(),
            "K" => self.K.is_some(),
            "lambda" => self.lambda.is_some(),
            _ => false,
        }
    }
}

const PAIRS: &str =
    "needs exactly two elastic constants: (E, nu), (E, G), (nu, G), (nu, K), (G, K) or (G, lambda)";

impl From<ParameterError> for LawError {
    fn from(error: ParameterError) -> Self {
        let parameter = error.parameter();
        let field = parameter.rsplit(' ').next().unwrap_or(parameter);
        LawError {
            field: field.to_owned(),
            message: error.to_string(),
        }
    }
}
