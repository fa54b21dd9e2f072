//! The operator W of the contact problem, kept from iteration to iteration where nothing in it changed.

use contact_bipotential::{CompliancePart, Contact, ContactMap};
use faer::Mat;

use crate::body::BodySystem;
use crate::memory::ContactMemory;

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
        memory.remember_stiffness(map, |k| (cone * k..cone * (k + 1)).map(|i| w[(i, i)]).sum());
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

fn is_same(a: &[Contact], b: &[Contact]) -> bool {
    let same = |(a, b): (&Contact, &Contact)| a.stencil == b.stencil && a.frame == b.frame;
    a.len() == b.len() && a.iter().zip(b).all(same)
}
