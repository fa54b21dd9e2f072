//! One law at one state, compared with what is demanded.

use nalgebra::Matrix3;

use super::Options;
use super::derivatives::{self, Derivatives};
use super::states::rotate;
use super::violation::{Component, Property, Violation};
use crate::inverted::Inverted;
use crate::material::{Material, Response};
use crate::tensor::{Symmetric, Tangent, engineering};

/// The rotated tangent is compared by its products with rotated strains, in which up to four entries add up.
const ROTATED_TANGENT: f64 = 4.0;

/// A law at a state, with the size its stresses are measured by.
pub(super) struct Probe<'a, M> {
    pub(super) material: &'a M,
    pub(super) c: Symmetric,
    pub(super) response: Response,
    pub(super) scale: f64,
}

impl<'a, M: Material> Probe<'a, M> {
    pub(super) fn new(material: &'a M, c: Symmetric) -> Result<Self, Violation> {
        let response = material
            .response(&c)
            .map_err(|source| Violation::Refused { c, source })?;
        // Stress and modulus: of the neo-Hookean law in large tension, the stress is by far the larger.
        let scale = response.stress.amax().max(response.tangent.amax());
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
        found: &Tangent,
        expected: &Tangent,
        allowed: f64,
    ) -> Result<(), Violation> {
        for i in 0..6 {
            for j in 0..6 {
                let component = Component::Tangent(i, j);
                self.same(
                    property,
                    component,
                    found[(i, j)],
                    expected[(i, j)],
                    allowed,
                )?;
            }
        }
        Ok(())
    }

    pub(super) fn check_finite(&self) -> Result<(), Violation> {
        let response = &self.response;
        let property = Property::Finite;
        // Zero times a finite number is zero, times any other it is NaN.
        let (s, d) = (response.stress * 0.0, response.tangent * 0.0);
        self.same(property, Component::Energy, 0.0 * response.energy, 0.0, 0.0)?;
        self.same_stresses(property, s.as_slice(), &[0.0; 6], 0.0)?;
        self.same_tangents(property, &d, &Tangent::zeros(), 0.0)
    }

    pub(super) fn check_methods(&self, options: &Options) -> Result<(), Violation> {
        let property = Property::SameFromAllMethods;
        let Response { energy, stress, .. } = &self.response;
        let allowed = options.tolerance * self.scale;
        let refused = |source| self.refused(source);
        let alone = self.material.energy(&self.c).map_err(refused)?;
        self.same(property, Component::Energy, alone, *energy, allowed)?;
        let (energy_too, stress_alone) = self.material.stress(&self.c).map_err(refused)?;
        self.same(property, Component::Energy, energy_too, *energy, allowed)?;
        self.same_stresses(
            property,
            stress_alone.as_slice(),
            stress.as_slice(),
            allowed,
        )
    }

    pub(super) fn check_symmetry(&self, options: &Options) -> Result<(), Violation> {
        let tangent = &self.response.tangent;
        let allowed = options.symmetry_tolerance * self.scale;
        self.same_tangents(
            Property::TangentIsSymmetric,
            tangent,
            &tangent.transpose(),
            allowed,
        )
    }

    pub(super) fn check_derivatives(&self, options: &Options) -> Result<(), Violation> {
        let Response {
            stress, tangent, ..
        } = &self.response;
        let compare = |expected: &Derivatives, properties: [Property; 2], tolerance: f64| {
            let allowed = tolerance * self.scale;
            let expected_stress = expected.stress.as_slice();
            self.same_stresses(properties[0], stress.as_slice(), expected_stress, allowed)?;
            self.same_tangents(properties[1], tangent, &expected.tangent, allowed)
        };
        let refused = |source| self.refused(source);
        let exact = derivatives::by_dual_numbers(self.material, &self.c).map_err(refused)?;
        let properties = [
            Property::StressIsDerivativeOfEnergy,
            Property::TangentIsSecondDerivativeOfEnergy,
        ];
        compare(&exact, properties, options.tolerance)?;
        let near = derivatives::by_differences(self.material, &self.c).map_err(refused)?;
        let properties = [
            Property::StressIsDifferenceOfEnergy,
            Property::TangentIsDifferenceOfStress,
        ];
        compare(&near, properties, options.difference_tolerance)
    }

    // `rotated` is this state, rotated by `q`.
    pub(super) fn check_isotropy(
        &self,
        rotated: &Self,
        q: &Matrix3<f64>,
        options: &Options,
    ) -> Result<(), Violation> {
        let allowed = options.tolerance * self.scale;
        let (here, there) = (&self.response, &rotated.response);
        let property = Property::EnergyIsIsotropic;
        rotated.same(
            property,
            Component::Energy,
            there.energy,
            here.energy,
            allowed,
        )?;
        let stress = rotate(&here.stress, q);
        let property = Property::StressIsIsotropic;
        rotated.same_stresses(
            property,
            there.stress.as_slice(),
            stress.as_slice(),
            allowed,
        )?;
        for j in 0..6 {
            let mut strain = Symmetric::zeros();
            strain[j] = 1.0;
            let expected = rotate(&(here.tangent * engineering(&strain)), q);
            let found = there.tangent * engineering(&rotate(&strain, q));
            for i in 0..6 {
                rotated.same(
                    Property::TangentIsIsotropic,
                    Component::Tangent(i, j),
                    found[i],
                    expected[i],
                    ROTATED_TANGENT * allowed,
                )?;
            }
        }
        Ok(())
    }
}
