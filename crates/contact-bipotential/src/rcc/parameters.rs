//! The parameters of adhesion and their bounds.

use crate::error::ParameterError;

/// Whether broken bonds form again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
pub enum Update {
    /// Exact for a constant `k`, second order in `beta`, stiffly accurate; the force is that of the end of the step.
    #[default]
    SecondOrder,
    /// Midpoint pair: the discrete energy balance of the bond is exact. Needs `b > 0`.
    EnergyConsistent,
}

/// Parameters of the adhesion of an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Recoverable adhesion with the defaults of \[Hu2022\]: bonds start at zero and form in contact only.
    #[must_use]
    pub fn new(normal: f64, tangential: f64, energy: f64, viscosity: f64) -> Self {
        Self {
            normal_stiffness: normal,
            tangential_stiffness: [tangential; 2],
            energy,
            viscosity,
            threshold: 1e-4,
            healing_gap: 0.0,
            initial: 0.0,
            healing: Healing::Recoverable,
            reference: Reference::Reset,
            update: Update::SecondOrder,
            bonded_friction: None,
        }
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

    /// The intensity that a bond at rest at the gap `x_n` \[m\] starts with at most \[-\]: `min(1, w/k)` if `b = 0`, else 1,
    /// which takes time to fall.
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
