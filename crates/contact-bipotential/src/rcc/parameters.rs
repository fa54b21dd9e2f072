//! The parameters of adhesion and their bounds.

use crate::error::ParameterError;

/// Whether broken bonds form again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Healing {
    /// `beta` rises again in contact \[Hu2022\].
    #[default]
    Recoverable,
    /// `beta` never rises \[Raous1999\].
    Irreversible,
}

/// What the tangential separation is measured from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Reference {
    /// The place of bonding; forgotten when the pair parts with a broken bond.
    #[default]
    Reset,
    /// New bonds are unstressed: while bonds can form, the reference follows at the rate `w / (b beta)`.
    Ageing,
}

/// How `beta` and the bond force are integrated over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Update {
    /// Exact for a constant `k`, second order in `beta`, stiffly accurate; the force is that of the end of the step.
    #[default]
    SecondOrder,
    /// Midpoint pair: the discrete energy balance of the bond is exact. Needs `b > 0`.
    EnergyConsistent,
}

/// Default of [`Adhesion::threshold`] \[-\]: a bond that weak pulls with a hundred-millionth of its stiffness.
pub const DEFAULT_THRESHOLD: f64 = 1e-4;

/// Parameters of the adhesion of an interface.
///
/// ```
/// use contact_bipotential::Adhesion;
/// use contact_bipotential::rcc::Healing;
///
/// // C_n = C_t = 2 GN/m^3, w = 20 J/m^2, b = 0.1 N s/m; glued at the start, and never again.
/// let glue = Adhesion::new(2e9, 2e9, 20.0, 0.1).with_initial(1.0).with_healing(Healing::Irreversible);
/// // Bonds start to break at sqrt(w / C) = 0.1 mm.
/// assert!((glue.damage_gap() - 1e-4).abs() < 1e-18);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Adhesion {
    /// `C_n`: force per area and gap of intact bonds \[N/m^3\], >= 0.
    pub normal_stiffness: f64,
    /// `C_t` along `t1` and `t2`: force per area and separation of intact bonds \[N/m^3\], >= 0.
    pub tangential_stiffness: [f64; 2],
    /// `w`: work per area that separation takes \[J/m^2\], >= 0.
    pub energy: f64,
    /// `b`: viscosity of breaking and healing \[N s/m\], >= 0; 0 is the rate-independent limit.
    pub viscosity: f64,
    /// `epsilon`: below this intensity a bond that has parted counts as broken \[-\], in (0, 1).
    pub threshold: f64,
    /// Gap up to which bonds form \[m\], >= 0.
    pub healing_gap: f64,
    /// `beta` at the start of the pairs that touch then \[-\], in [0, 1].
    pub initial: f64,
    /// Whether broken bonds form again.
    pub healing: Healing,
    /// What the tangential separation is measured from.
    pub reference: Reference,
    /// How a step is integrated.
    pub update: Update,
    /// Coulomb coefficient of intact bonds \[-\], >= 0; between it and that of the interface `mu` is linear in `beta`.
    pub bonded_friction: Option<f64>,
}

impl Adhesion {
    /// Recoverable adhesion with the defaults of \[Hu2022\]: bonds start at zero and form in contact only. `normal` and
    /// `tangential` are the stiffnesses \[N/m^3\], `energy` is `w` \[J/m^2\], `viscosity` is `b` \[N s/m\].
    #[must_use]
    pub const fn new(normal: f64, tangential: f64, energy: f64, viscosity: f64) -> Self {
        Self {
            normal_stiffness: normal,
            tangential_stiffness: [tangential; 2],
            energy,
            viscosity,
            threshold: DEFAULT_THRESHOLD,
            healing_gap: 0.0,
            initial: 0.0,
            healing: Healing::Recoverable,
            reference: Reference::Reset,
            update: Update::SecondOrder,
            bonded_friction: None,
        }
    }

    /// The same with another stiffness along each tangent, `t1` and `t2` \[N/m^3\].
    #[must_use]
    pub const fn with_tangential_stiffness(mut self, tangential_stiffness: [f64; 2]) -> Self {
        self.tangential_stiffness = tangential_stiffness;
        self
    }

    /// The same with another [`threshold`](Self::threshold) \[-\].
    #[must_use]
    pub const fn with_threshold(mut self, threshold: f64) -> Self {
        self.threshold = threshold;
        self
    }

    /// The same with bonds that form up to the gap `healing_gap` \[m\].
    #[must_use]
    pub const fn with_healing_gap(mut self, healing_gap: f64) -> Self {
        self.healing_gap = healing_gap;
        self
    }

    /// The same with bonds of the intensity `initial` \[-\] where surfaces touch at the start.
    #[must_use]
    pub const fn with_initial(mut self, initial: f64) -> Self {
        self.initial = initial;
        self
    }

    /// The same with broken bonds that form again, or do not.
    #[must_use]
    pub const fn with_healing(mut self, healing: Healing) -> Self {
        self.healing = healing;
        self
    }

    /// The same with another reference of the tangential separation.
    #[must_use]
    pub const fn with_reference(mut self, reference: Reference) -> Self {
        self.reference = reference;
        self
    }

    /// The same with another integration over a step.
    #[must_use]
    pub const fn with_update(mut self, update: Update) -> Self {
        self.update = update;
        self
    }

    /// The same with a Coulomb coefficient of intact bonds \[-\], or that of the bare surfaces.
    #[must_use]
    pub const fn with_bonded_friction(mut self, bonded_friction: Option<f64>) -> Self {
        self.bonded_friction = bonded_friction;
        self
    }

    /// The same parameters, checked.
    ///
    /// # Errors
    /// [`ParameterError`] with the bound that is violated.
    pub fn validated(self) -> Result<Self, ParameterError> {
        let [t1, t2] = self.tangential_stiffness;
        let not_negative = "must be >= 0 and finite";
        let bounded = [
            ("C_n [N/m^3]", self.normal_stiffness, f64::MAX, not_negative),
            ("C_t [N/m^3]", t1, f64::MAX, not_negative),
            ("C_t [N/m^3]", t2, f64::MAX, not_negative),
            ("w [J/m^2]", self.energy, f64::MAX, not_negative),
            ("b [N s/m]", self.viscosity, f64::MAX, not_negative),
            ("healing gap [m]", self.healing_gap, f64::MAX, not_negative),
            ("initial beta [-]", self.initial, 1.0, "must lie in [0, 1]"),
            (
                "mu of intact bonds [-]",
                self.bonded_friction.unwrap_or(0.0),
                f64::MAX,
                not_negative,
            ),
        ];
        for (name, value, most, bound) in bounded {
            if !(value >= 0.0 && value <= most) {
                return Err(ParameterError { name, value, bound });
            }
        }
        let refuse = |name, value, bound| Err(ParameterError { name, value, bound });
        if !(self.threshold > 0.0 && self.threshold < 1.0) {
            let bound = "must lie between 0 and 1, both excluded";
            return refuse("epsilon [-]", self.threshold, bound);
        }
        if self.energy > 0.0 && self.normal_stiffness == 0.0 && t1.max(t2) == 0.0 {
            let bound = "must be > 0 where w > 0: bonds without stiffness never break";
            return refuse("C_n and C_t [N/m^3]", 0.0, bound);
        }
        if self.healing == Healing::Irreversible && self.healing_gap > 0.0 {
            let bound = "must be 0 where bonds do not heal";
            return refuse("healing gap [m]", self.healing_gap, bound);
        }
        if self.update == Update::EnergyConsistent && self.viscosity == 0.0 {
            let bound = "must be > 0 for the energy-consistent update";
            return refuse("b [N s/m]", self.viscosity, bound);
        }
        Ok(self)
    }

    /// `sqrt(w / C_n)`: the gap at which intact bonds start to break \[m\].
    #[must_use]
    pub fn damage_gap(&self) -> f64 {
        let stiffness = self
            .tangential_stiffness
            .iter()
            .fold(self.normal_stiffness, |m, c| m.max(*c));
        if stiffness > 0.0 {
            (self.energy / stiffness).sqrt()
        } else {
            0.0
        }
    }

    /// The intensity that a bond at rest at the gap `x_n` \[m\] starts with at most \[-\]: `min(1, w/k)` if `b = 0`,
    /// else 1, which takes time to fall.
    #[must_use]
    pub fn lasting(&self, gap: f64) -> f64 {
        let k = self.strain(&[0.0; 2], gap);
        if self.viscosity > 0.0 || k <= self.energy {
            1.0
        } else {
            self.energy / k
        }
    }

    /// Whether bonds resist slip.
    #[must_use]
    pub fn is_tangential(&self) -> bool {
        self.tangential_stiffness != [0.0; 2]
    }

    /// `k` \[J/m^2\].
    pub(super) fn strain(&self, separation: &[f64; 2], gap: f64) -> f64 {
        let [t1, t2] = self.tangential_stiffness;
        self.normal_stiffness * gap * gap
            + t1 * separation[0] * separation[0]
            + t2 * separation[1] * separation[1]
    }
}
