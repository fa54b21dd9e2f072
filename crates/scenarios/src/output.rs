//! Results of a run in one folder.
//!
//! | file | content |
//! |---|---|
//! | `summary.json` | how the run ended and what it cost ([`Summary`]); `running` until then, always whole |
//! | `history.csv` | one row an accepted step, on disk as soon as the step is accepted ([`Row`]) |
//! | `fields.pvd`, `fields/*.vtu` | fields for ParaView and pyvista ([`Frame`]), reference positions and displacement |
//! | `*.svg` | the plots that the scene asks for |
//! | `sweep.csv` | beside the folders of the runs of a sweep: a row a run |
//! | `contact_step_N.hdf5` | the contact problem of step N as FCLib, with `--dump-contact N` |

mod csv;
mod earlier;
mod folder;
mod frame;
mod history;
mod labels;
mod lock;
mod plot;
mod results;
mod summary;
mod vtu;

use self::csv::HistoryFile;
pub use crate::energies::{ENERGY_TERMS, Energies, EnergyTerm};
pub use earlier::{earlier_results, remove_runs};
pub use folder::{Folder, OutputError};
pub use frame::{Array, Cells, Frame, Values};
pub use history::{Bonds, Force, History, Row};
pub use plot::{Axis, Band, Chart, Curve, MapFrame, Maps, Pen, charts_svg, deformed_svg, maps_svg};
use plot::{energy_svg, series_svg};
pub use results::Results;
pub use summary::{EnergySummary, Status, Summary, Units};
pub use vtu::vtu_bytes;
use vtu::write_pvd;
