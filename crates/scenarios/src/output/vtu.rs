//! VTK files: an unstructured grid a frame, and the collection over time.

use std::fmt::Write as _;
use std::io::{self, Write as _};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::frame::SYMMETRIC;
use super::{Array, Frame, Values};

/// Bytes compressed together; VTK reads any size.
const BLOCK: usize = 1 << 17;

/// A frame as a `.vtu` file: appended raw data, compressed by zlib, 64-bit headers, reference positions as points.
///
/// # Errors
/// What the compressor reports; writing to memory does not fail otherwise.
pub fn vtu_bytes(frame: &Frame<'_>) -> io::Result<Vec<u8>> {
    let mut file = Appended::default();
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n",
    );
    xml += "<FieldData>\n";
    xml += &file.array(
        "Float64",
        "TimeValue",
        " NumberOfTuples=\"1\"",
        &floats([frame.time]),
    )?;
    xml += "</FieldData>\n";
    let _ = writeln!(
        xml,
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
        frame.points.len(),
        frame.cell_count()
    );
    for (tag, data) in [
        ("PointData", &frame.point_data),
        ("CellData", &frame.cell_data),
    ] {
        let _ = writeln!(xml, "<{tag}>");
        for array in data {
            xml += &file.field(array)?;
        }
        let _ = writeln!(xml, "</{tag}>");
    }
    xml += "<Points>\n";
    let points = floats(frame.points.iter().flatten().copied());
    xml += &file.array("Float64", "Points", " NumberOfComponents=\"3\"", &points)?;
    xml += "</Points>\n<Cells>\n";
    xml += &file.cells(frame)?;
    xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    let mut bytes = xml.into_bytes();
    bytes.append(&mut file.data);
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    Ok(bytes)
}

/// A `.pvd` collection: `(time \[s\], file relative to the collection)`.
pub(super) fn write_pvd(files: &[(f64, String)]) -> String {
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (time, file) in files {
        let _ = writeln!(
            xml,
            "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{}\"/>",
            escape(file)
        );
    }
    xml + "</Collection>\n</VTKFile>\n"
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn floats(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    values.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// Appended section under construction.
#[derive(Default)]
struct Appended {
    data: Vec<u8>,
}

impl Appended {
    /// Appends raw bytes as one compressed array; its XML element.
    fn array(
        &mut self,
        kind: &str,
        name: &str,
        attributes: &str,
        bytes: &[u8],
    ) -> io::Result<String> {
        let offset = self.data.len();
        let blocks = bytes
            .chunks(BLOCK)
            .map(compress)
            .collect::<io::Result<Vec<_>>>()?;
        let head = [blocks.len(), BLOCK, bytes.len() % BLOCK];
        for number in head.into_iter().chain(blocks.iter().map(Vec::len)) {
            self.data.extend_from_slice(&(number as u64).to_le_bytes());
        }
        self.data.extend(blocks.into_iter().flatten());
        let name = escape(name);
        Ok(format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\"{attributes} format=\"appended\" offset=\"{offset}\"/>\n"
        ))
    }

    fn field(&mut self, array: &Array<'_>) -> io::Result<String> {
        let components = format!(" NumberOfComponents=\"{}\"", array.values.components());
        match array.values {
            Values::Scalar(values) | Values::Vector(values) => self.array(
                "Float64",
                array.name,
                &components,
                &floats(values.iter().copied()),
            ),
            Values::SymmetricTensor(values) => {
                let names = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
                let names = names
                    .iter()
                    .enumerate()
                    .map(|(i, n)| format!(" ComponentName{i}=\"{n}\""));
                let attributes = components + &names.collect::<String>();
                let vtk = values
                    .chunks_exact(SYMMETRIC)
                    .flat_map(|s| [s[0], s[1], s[2], s[3], s[5], s[4]]);
                self.array("Float64", array.name, &attributes, &floats(vtk))
            }
            Values::Integer(values) => {
                let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
                self.array("Int32", array.name, &components, &bytes)
            }
        }
    }

    fn cells(&mut self, frame: &Frame<'_>) -> io::Result<String> {
        let mut connectivity = Vec::new();
        let mut offsets = Vec::new();
        let mut types = Vec::new();
        let mut end = 0_i64;
        for cells in &frame.cells {
            connectivity.extend(
                cells
                    .connectivity
                    .iter()
                    .flat_map(|node| i64::from(*node).to_le_bytes()),
            );
            for _ in 0..cells.count() {
                end += cells.kind.node_count() as i64;
                offsets.extend(end.to_le_bytes());
                types.push(cells.kind.vtk_type());
            }
        }
        Ok(self.array("Int64", "connectivity", "", &connectivity)?
            + &self.array("Int64", "offsets", "", &offsets)?
            + &self.array("UInt8", "types", "", &types)?)
    }
}

fn compress(block: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(block)?;
    encoder.finish()
}
