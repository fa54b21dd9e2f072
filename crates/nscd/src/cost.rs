//! What work costs, from operation counts: clocks would make runs differ from each other.

/// Estimated seconds of the parts of an iteration. Only their ratios matter, and they decide one thing: whether a new
/// tangent pays, that is whether it costs less than the iterations that it saves (`Monitor::is_stale`). `Settings::lag`
/// scales the cost of a tangent against that of an iteration.
///
/// Round numbers for one thread of a usual core. They are constants, not measured at the start, so that runs repeat.
/// `cargo test --release -p nscd costs_on_one_thread -- --ignored --nocapture` measures each and prints it beside the
/// one in use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CostModel {
    /// Multiplications and additions of a factorization or condensation in a second \[1/s\].
    pub(crate) factor_rate: f64,
    /// Gathering one entry of a matrix from the elements \[s\].
    pub(crate) gathered_entry: f64,
    /// One entry of a factor in a forward and a backward substitution \[s\].
    pub(crate) substituted_entry: f64,
    /// One entry of a matrix in the check of a solve \[s\].
    pub(crate) checked_entry: f64,
    /// Force of one element \[s\].
    pub(crate) element_force: f64,
    /// One entry of `W` in a contact solve, which takes a few products with it \[s\].
    pub(crate) contact_entry: f64,
}

/// The costs in use.
pub(crate) const COSTS: CostModel = CostModel {
    factor_rate: 8e9,
    gathered_entry: 4e-9,
    substituted_entry: 2.5e-9,
    checked_entry: 1e-9,
    element_force: 1e-6,
    contact_entry: 3e-8,
};

impl CostModel {
    /// A factorization of so many operations with the condensation onto `candidates` unknowns, of a matrix with
    /// `entries` \[s\].
    pub(crate) fn factorization(&self, flops: f64, candidates: usize, entries: usize) -> f64 {
        let condensation = (candidates as f64).powi(3);
        (flops + condensation) / self.factor_rate + entries as f64 * self.gathered_entry
    }

    /// A forward and backward substitution with its check \[s\].
    pub(crate) fn substitution(&self, fill: usize, entries: usize) -> f64 {
        fill as f64 * self.substituted_entry + entries as f64 * self.checked_entry
    }

    /// Forces of so many elements \[s\].
    pub(crate) fn element_forces(&self, elements: usize) -> f64 {
        elements as f64 * self.element_force
    }

    /// A contact solve with so many rows \[s\].
    pub(crate) fn contact_solve(&self, rows: usize) -> f64 {
        let n = rows as f64;
        n * n * self.contact_entry
    }
}
