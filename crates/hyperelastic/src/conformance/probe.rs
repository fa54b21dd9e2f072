//! One law at one state, compared with what is demanded.

use super::{Component, Options, Property, Violation, derivatives, states};
use crate::material::{Inverted, Material, Response};

/// A law at a state, with the size its stresses are measured by.
pub(super) struct Probe<'a, M> {
    pub(super) material: &'a M,
    pub(super) c: [f64; 6],
    pub(super) response: Response,
    pub(super) scale: f64,
}

impl<'a, M: Material> Probe<'a, M> {
    pub(super) fn new(material: &'a M, c: [f64; 6]) -> Result<Self, Violation> {
        let response = material
            .response(&c)
            .map_err(|source| Violation::Refused { c, source })?;
        // Stress and modulus: of the neo-Hookean law in large tension, the stress is by far the larger.
        let numbers = response
            .stress
            .iter()
            .chain(response.tangent.as_flattened());
        let scale = numbers.fold(0.0, |scale: f64, x| scale.max(x.abs()));
        let probe = Self {
            material,
            c,
            response,
            scale,
        };
        probe.check_finite()?;
        Ok(probe)
    }

    fn refused(&self, source: Inverted) -> Violation {
        Violation::Refused { c: self.c, source }
    }

    pub(super) fn same(
        &self,
        property: Property,
        component: Component,
        found: f64,
        expected: f64,
        allowed: f64,
    ) -> Result<(), Violation> {
        // Written so that NaN fails.
        if (found - expected).abs() <= allowed {
            return Ok(());
        }
        Err(Violation::Differs {
            property,
            c: self.c,
            component,
            found,
            expected,
            allowed,
        })
    }

    pub(super) fn same_stresses(
        &self,
        property: Property,
        found: &[f64],
        expected: &[f64],
        allowed: f64,
    ) -> Result<(), Violation> {
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            self.same(property, Component::Stress(i), *found, *expected, allowed)?;
        }
        Ok(())
    }

    pub(super) fn same_tangents(
        &self,
        property: Property,
        found: &[[f64; 6]; 6],
        expected: &[[f64; 6]; 6],
        allowed: f64,
    ) -> Result<(), Violation> {
        for i in 0..6 {
            for j in 0..6 {
                self.same(
                    property,
                    Component::Tangent(i, j),
                    found[i][j],
                    expected[i][j],
                    allowed,
                )?;
            }
        }
        Ok(())
    }

    pub(super) fn check_finite(&self) -> Result<(), Violation> {
        let Response {
            energy,
            stress,
            tangent,
        } = &self.response;
        let zero = |x: f64| 0.0 * x;
        self.same(Property::Finite, Component::Energy, zero(*energy), 0.0, 0.0)?;
        self.same_stresses(Property::Finite, &stress.map(zero), &[0.0; 6], 0.0)?;
        self.same_tangents(
            Property::Finite,
            &tangent.map(|row| row.map(zero)),
            &[[0.0; 6]; 6],
            0.0,
        )
    }

    pub(super) fn check_methods(&self, options: &Options) -> Result<(), Violation> {
        let property = Property::SameFromAllMethods;
        let Response {
            energy,
            stress,
            tangent,
        } = &self.response;
        let allowed = options.tolerance * self.scale;
        let alone = self
            .material
            .energy(&self.c)
            .map_err(|source| self.refused(source))?;
        self.same(property, Component::Energy, alone, *energy, allowed)?;
        let (energy_too, stress_alone) = self
            .material
            .stress(&self.c)
            .map_err(|source| self.refused(source))?;
        self.same(property, Component::Energy, energy_too, *energy, allowed)?;
        self.same_stresses(property, &stress_alone, stress, allowed)?;
        for i in 0..6 {
            for j in 0..i {
                let (found, expected) = (tangent[i][j], tangent[j][i]);
                self.same(
                    Property::TangentIsSymmetric,
                    Component::Tangent(i, j),
                    found,
                    expected,
                    0.0,
                )?;
            }
        }
        Ok(())
    }

    pub(super) fn check_derivatives(&self, options: &Options) -> Result<(), Violation> {
        let Response {
            stress, tangent, ..
        } = &self.response;
        let (material, c) = (self.material, &self.c);

        let exact =
            derivatives::by_dual_numbers(material, c).map_err(|source| self.refused(source))?;
        let allowed = options.tolerance * self.scale;
        self.same_stresses(
            Property::StressIsDerivativeOfEnergy,
            stress,
            &exact.stress,
            allowed,
        )?;
        self.same_tangents(
            Property::TangentIsSecondDerivativeOfEnergy,
            tangent,
            &exact.tangent,
            allowed,
        )?;

        let near =
            derivatives::by_differences(material, c).map_err(|source| self.refused(source))?;
        let allowed = options.difference_tolerance * self.scale;
        self.same_stresses(
            Property::StressIsDifferenceOfEnergy,
            stress,
            &near.stress,
            allowed,
        )?;
        self.same_tangents(
            Property::TangentIsDifferenceOfStress,
            tangent,
            &near.tangent,
            allowed,
        )
    }

    // `rotated` is this state, rotated by `q`.
    pub(super) fn check_isotropy(
        &self,
        rotated: &Self,
        q: &[[f64; 3]; 3],
        options: &Options,
    ) -> Result<(), Violation> {
        let allowed = options.tolerance * self.scale;
        let (energy, found) = (self.response.energy, &rotated.response);
        rotated.same(
            Property::EnergyIsIsotropic,
            Component::Energy,
            found.energy,
            energy,
            allowed,
        )?;
        let stress = states::rotate(&self.response.stress, q);
        rotated.same_stresses(Property::StressIsIsotropic, &found.stress, &stress, allowed)?;
        for j in 0..6 {
            let (strain, engineering) = states::unit_strain(j);
            let stress = states::rotate(&states::times(&self.response.tangent, &engineering), q);
            let strain = states::rotate(&strain, q);
            let engineering = states::engineering(&strain);
            let turned = states::times(&found.tangent, &engineering);
            for i in 0..6 {
                let component = Component::Tangent(i, j);
                rotated.same(
                    Property::TangentIsIsotropic,
                    component,
                    turned[i],
                    stress[i],
                    4.0 * allowed,
                )?;
            }
        }
        Ok(())
    }
}
