//! What can be wrong with contact data.

use thiserror::Error;

/// Contact data that cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A cone has 1, 2 or 3 entries.
    #[error("a contact has {dim} components: give 1 (normal only), 2 (plane) or 3 (space)")]
    ConeDimension {
        /// Entries a contact.
        dim: usize,
    },
    /// Two arrays that belong together differ in length.
    #[error("{what} has {found} entries where the {contacts} contacts ask for {expected}")]
    Length {
        /// Name of the array.
        what: &'static str,
        /// Number of contacts.
        contacts: usize,
        /// Length found.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// A number that is NaN or infinite.
    #[error(
        "{what} holds {value} at entry {entry} (contact {contact}): every number must be finite"
    )]
    NotFinite {
        /// Name of the array.
        what: &'static str,
        /// Contact.
        contact: usize,
        /// Position in the array.
        entry: usize,
        /// The number.
        value: f64,
    },
    /// Friction coefficients lie in `[0, inf)`.
    #[error("contact {contact} has friction coefficient {mu}: it must be finite and not negative")]
    Friction {
        /// Contact.
        contact: usize,
        /// The coefficient.
        mu: f64,
    },
    /// A contact that does not move when it is pushed.
    #[error(
        "contact {contact} has compliance {value:e} along its normal: pushing must move it away, so W_nn > 0"
    )]
    Compliance {
        /// Contact.
        contact: usize,
        /// `W_nn`.
        value: f64,
    },
    /// A block outside of the matrix.
    #[error("block ({row}, {column}) lies outside of a matrix of {contacts} contacts")]
    Block {
        /// Contact of the row.
        row: usize,
        /// Contact of the column.
        column: usize,
        /// Number of contacts.
        contacts: usize,
    },
    /// Column or row indices of a sparse matrix that do not fit it.
    #[error("{what}: entry ({row}, {column}) lies outside of {rows} x {columns}")]
    Entry {
        /// Name of the matrix.
        what: &'static str,
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
    },
    /// The mass or stiffness matrix of the global form cannot be factorised.
    #[error(
        "the matrix M of the global form ({size} unknowns) cannot be factorised: {reason}; constrain every rigid motion"
    )]
    Factorization {
        /// Number of unknowns.
        size: usize,
        /// What the factorisation said.
        reason: String,
    },
}

/// A parameter outside of its bound.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
#[error("{name} is {value}: it {bound}")]
pub struct ParameterError {
    /// Name and unit of the parameter.
    pub name: &'static str,
    /// Its value, in the unit that the name says \[N/m^3, J/m^2, ..\].
    pub value: f64,
    /// The bound.
    pub bound: &'static str,
}
