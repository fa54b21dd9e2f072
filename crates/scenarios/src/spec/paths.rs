//! All dotted paths of a value, defaults included: a serde serializer that keeps the names and drops the values.

use serde::ser::{self, Serialize};
use std::fmt;

use super::locate::join;

/// Dotted paths of all fields, keys and positions inside `value`, outer before inner. Variants and `Some` take no
/// part in a path, as in the text (see [`SpanTree`](super::SpanTree)).
#[must_use]
pub fn field_paths<T: Serialize + ?Sized>(value: &T) -> Vec<String> {
    let mut found = Vec::new();
    // Fails only for map keys that are not strings, which no scene has.
    let _ = value.serialize(Collector {
        prefix: String::new(),
        found: &mut found,
    });
    found
}

#[derive(Debug)]
struct NotAKey;

impl fmt::Display for NotAKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map key is not a string")
    }
}

impl std::error::Error for NotAKey {}

impl ser::Error for NotAKey {
    fn custom<T: fmt::Display>(_: T) -> Self {
        NotAKey
    }
}

struct Collector<'a> {
    prefix: String,
    found: &'a mut Vec<String>,
}

/// Inside a compound value.
struct Inside<'a> {
    prefix: String,
    found: &'a mut Vec<String>,
    index: usize,
    key: String,
}

impl<'a> Collector<'a> {
    fn inside(self) -> Inside<'a> {
        Inside {
            prefix: self.prefix,
            found: self.found,
            index: 0,
            key: String::new(),
        }
    }
}

impl Inside<'_> {
    fn add<T: Serialize + ?Sized>(&mut self, name: &str, value: &T) -> Result<(), NotAKey> {
        let path = join(&self.prefix, name);
        self.found.push(path.clone());
        value.serialize(Collector {
            prefix: path,
            found: self.found,
        })
    }

    fn add_next<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), NotAKey> {
        let name = self.index.to_string();
        self.index += 1;
        self.add(&name, value)
    }
}

macro_rules! leaves {
    ($($method:ident: $type:ty),* $(,)?) => {
        $(fn $method(self, _: $type) -> Result<(), NotAKey> { Ok(()) })*
    };
}

macro_rules! compounds {
    ($($method:ident: $($argument:ty),+;)*) => {
        $(fn $method(self, $(_: $argument),+) -> Result<Inside<'a>, NotAKey> {
            Ok(self.inside())
        })*
    };
}

impl<'a> ser::Serializer for Collector<'a> {
    type Ok = ();
    type Error = NotAKey;
    type SerializeSeq = Inside<'a>;
    type SerializeTuple = Inside<'a>;
    type SerializeTupleStruct = Inside<'a>;
    type SerializeTupleVariant = Inside<'a>;
    type SerializeMap = Inside<'a>;
    type SerializeStruct = Inside<'a>;
    type SerializeStructVariant = Inside<'a>;

    leaves! {
        serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64,
        serialize_f32: f32, serialize_f64: f64, serialize_char: char, serialize_str: &str,
        serialize_bytes: &[u8], serialize_unit_struct: &'static str,
    }

    fn serialize_none(self) -> Result<(), NotAKey> {
        Ok(())
    }

    fn serialize_unit(self) -> Result<(), NotAKey> {
        Ok(())
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), NotAKey> {
        value.serialize(self)
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
    ) -> Result<(), NotAKey> {
        Ok(())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), NotAKey> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), NotAKey> {
        value.serialize(self)
    }

    compounds! {
        serialize_seq: Option<usize>;
        serialize_tuple: usize;
        serialize_tuple_struct: &'static str, usize;
        serialize_tuple_variant: &'static str, u32, &'static str, usize;
        serialize_map: Option<usize>;
        serialize_struct: &'static str, usize;
        serialize_struct_variant: &'static str, u32, &'static str, usize;
    }
}

macro_rules! positions {
    ($($interface:ident :: $method:ident),* $(,)?) => {
        $(impl ser::$interface for Inside<'_> {
            type Ok = ();
            type Error = NotAKey;
            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), NotAKey> {
                self.add_next(value)
            }
            fn end(self) -> Result<(), NotAKey> { Ok(()) }
        })*
    };
}

positions!(
    SerializeSeq::serialize_element,
    SerializeTuple::serialize_element,
    SerializeTupleStruct::serialize_field,
    SerializeTupleVariant::serialize_field,
);

macro_rules! fields {
    ($($interface:ident),*) => {
        $(impl ser::$interface for Inside<'_> {
            type Ok = ();
            type Error = NotAKey;
            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                name: &'static str,
                value: &T,
            ) -> Result<(), NotAKey> {
                self.add(name, value)
            }
            fn end(self) -> Result<(), NotAKey> { Ok(()) }
        })*
    };
}

fields!(SerializeStruct, SerializeStructVariant);

impl ser::SerializeMap for Inside<'_> {
    type Ok = ();
    type Error = NotAKey;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), NotAKey> {
        match serde_json::to_value(key) {
            Ok(serde_json::Value::String(text)) => self.key = text,
            _ => return Err(NotAKey),
        }
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), NotAKey> {
        let key = std::mem::take(&mut self.key);
        self.add(&key, value)
    }

    fn end(self) -> Result<(), NotAKey> {
        Ok(())
    }
}
