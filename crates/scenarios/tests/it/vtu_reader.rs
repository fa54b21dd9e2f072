//! A reader of `.vtu` files for tests, written from the format's description and not from our writer.

use std::collections::BTreeMap;
use std::io::Read as _;

/// Raw bytes of every array by name, and the attributes of its element.
pub(crate) struct Vtu {
    pub(crate) head: String,
    arrays: BTreeMap<String, (String, Vec<u8>)>,
}

fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let start = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[start..].split('"').next()
}

fn number(bytes: &[u8], index: usize) -> usize {
    u64::from_le_bytes(bytes[8 * index..8 * index + 8].try_into().unwrap()) as usize
}

fn inflate(data: &[u8]) -> Vec<u8> {
    let (blocks, size, last) = (number(data, 0), number(data, 1), number(data, 2));
    let mut at = 8 * (3 + blocks);
    let mut bytes = Vec::new();
    for block in 0..blocks {
        let packed = number(data, 3 + block);
        let before = bytes.len();
        flate2::read::ZlibDecoder::new(&data[at..at + packed])
            .read_to_end(&mut bytes)
            .unwrap();
        let partial = block + 1 == blocks && last > 0;
        assert_eq!(bytes.len() - before, if partial { last } else { size });
        at += packed;
    }
    bytes
}

impl Vtu {
    pub(crate) fn read(file: &[u8]) -> Vtu {
        let marker = b"<AppendedData encoding=\"raw\">";
        let start = file
            .windows(marker.len())
            .position(|w| w == marker)
            .unwrap();
        let head = String::from_utf8(file[..start].to_vec()).unwrap();
        let data = start + file[start..].iter().position(|b| *b == b'_').unwrap() + 1;
        let arrays = head.match_indices("<DataArray").map(|(i, _)| {
            let element = head[i..].split('>').next().unwrap().to_owned();
            let offset: usize = attribute(&element, "offset").unwrap().parse().unwrap();
            let name = attribute(&element, "Name").unwrap().to_owned();
            (name, (element, inflate(&file[data + offset..])))
        });
        let arrays = arrays.collect();
        Vtu { head, arrays }
    }

    pub(crate) fn attribute(&self, array: &str, name: &str) -> Option<&str> {
        attribute(&self.arrays[array].0, name)
    }

    pub(crate) fn floats(&self, array: &str) -> Vec<f64> {
        assert_eq!(self.attribute(array, "type"), Some("Float64"));
        self.arrays[array]
            .1
            .chunks_exact(8)
            .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
            .collect()
    }

    pub(crate) fn integers(&self, array: &str) -> Vec<i64> {
        let (element, bytes) = &self.arrays[array];
        match attribute(element, "type") {
            Some("Int64") => bytes
                .chunks_exact(8)
                .map(|b| i64::from_le_bytes(b.try_into().unwrap()))
                .collect(),
            Some("Int32") => bytes
                .chunks_exact(4)
                .map(|b| i32::from_le_bytes(b.try_into().unwrap()).into())
                .collect(),
            Some("UInt8") => bytes.iter().map(|b| i64::from(*b)).collect(),
            other => panic!("{other:?}"),
        }
    }
}
