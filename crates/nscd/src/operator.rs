//! The operator W of the contact problem, kept from iteration to iteration where nothing in it changed.

use contact_bipotential::{CompliancePart, Contact, ContactMap};
use faer::Mat;

use crate::body::BodySystem;
use crate::memory::ContactMemory;

/// Least part of the compliance of a contact that counts as its body's own, where springs hold that \[-\].
const OWN_COMPLIANCE: f64 = 1e-3;

/// `W` of the last contact problem: it holds as long as no frame, no stencil and no factor changed, which is the rule
/// between bodies and rigid planes.
#[derive(Debug, Default)]
pub(crate) struct ContactOperator {
    kept: Option<Kept>,
    /// Factorizations of the bodies that the present operator stands on.
    epochs: Vec<u64>,
}

#[derive(Debug)]
struct Kept {
    contacts: Vec<Contact>,
    /// Factorizations of the bodies at the time.
    epochs: Vec<u64>,
    w: Mat<f64>,
}

impl ContactOperator {
    /// `W = H C H^T` \[m/N\] of the contacts of a map.
    pub(crate) fn assemble(
        &mut self,
        map: &ContactMap,
        bodies: &[BodySystem],
        memory: &mut ContactMemory,
    ) -> Mat<f64> {
        self.epochs = bodies.iter().map(BodySystem::epoch).collect();
        if let Some(last) = self.kept.take()
            && last.epochs == self.epochs
            && is_same(&last.contacts, &map.contacts)
        {
            return last.w;
        }
        let parts: Vec<&CompliancePart> = bodies.iter().filter_map(BodySystem::condensed).collect();
        let mut w = Mat::zeros(map.row_count(), map.row_count());
        map.delassus(&parts, &mut w);
        let cone = map.cone().dim();
        let excess = anchor_compliance(map, bodies);
        memory.remember_stiffness(map, |k| {
            let rows = cone * k..cone * (k + 1);
            let trace = rows.clone().map(|i| w[(i, i)]).sum::<f64>();
            let soft = rows.map(|i| excess.get(i).unwrap_or(&0.0)).sum::<f64>();
            (trace - soft).max(OWN_COMPLIANCE * trace)
        });
        w
    }

    /// Keeps the operator that [`Self::assemble`] gave out last.
    pub(crate) fn keep(&mut self, contacts: Vec<Contact>, w: Mat<f64>) {
        self.kept = Some(Kept {
            contacts,
            epochs: self.epochs.clone(),
            w,
        });
    }

    /// The operator that is kept.
    pub(crate) fn kept(&self) -> Option<&Mat<f64>> {
        self.kept.as_ref().map(|kept| &kept.w)
    }
}

/// What the softness of the springs that hold floating bodies adds to the diagonal of `W` \[m/N\], beyond springs as
/// stiff as the body: no measure for what a gap means. Empty where no body floats.
fn anchor_compliance(map: &ContactMap, bodies: &[BodySystem]) -> Vec<f64> {
    let mut sum = Vec::new();
    for anchors in bodies.iter().map(BodySystem::anchors) {
        for motion in anchors.motions() {
            let mut moved = vec![0.0; map.row_count()];
            map.apply(motion, &mut moved);
            sum.resize(map.row_count(), 0.0);
            let rows = sum.iter_mut().zip(&moved);
            rows.for_each(|(sum, x)| *sum += anchors.excess() * x * x);
        }
    }
    sum
}

fn is_same(a: &[Contact], b: &[Contact]) -> bool {
    let same = |(a, b): (&Contact, &Contact)| a.stencil == b.stencil && a.frame == b.frame;
    a.len() == b.len() && a.iter().zip(b).all(same)
}
