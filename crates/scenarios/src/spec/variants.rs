//! Enums whose variants are structs, as a scene writes them: `Box(min: ..)`, where a derived implementation would read
//! `Box((min: ..))`.

use serde::de::{self, VariantAccess, Visitor};
use serde::{Deserializer, forward_to_deserialize_any};

/// The fields of a variant as those of a struct.
pub(super) struct Fields<A>(pub(super) A);

impl<'de, A: VariantAccess<'de>> Deserializer<'de> for Fields<A> {
    type Error = A::Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, A::Error> {
        self.0.struct_variant(fields, visitor)
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, A::Error> {
        Err(de::Error::custom("a variant has named fields"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

/// Defines an enum whose variants hold a struct each, reads it from a scene and knows the names of its variants.
macro_rules! struct_variants {
    (
        $(#[$about:meta])*
        pub enum $choice:ident {
            $($(#[$meaning:meta])* $variant:ident($fields:ty),)*
        }
    ) => {
        $(#[$about])*
        pub enum $choice {
            $($(#[$meaning])* $variant($fields),)*
        }

        impl $choice {
            /// Name of the variant, as in a scene.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $($choice::$variant(_) => stringify!($variant),)*
                }
            }
        }

        impl<'de> serde::Deserialize<'de> for $choice {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                #[derive(serde::Deserialize)]
                #[serde(variant_identifier)]
                enum Name {
                    $($variant,)*
                }

                struct Reader;

                impl<'de> serde::de::Visitor<'de> for Reader {
                    type Value = $choice;

                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str(concat!("enum ", stringify!($choice)))
                    }

                    fn visit_enum<A: serde::de::EnumAccess<'de>>(
                        self,
                        data: A,
                    ) -> Result<$choice, A::Error> {
                        let (name, fields) = data.variant()?;
                        let fields = $crate::spec::variants::Fields(fields);
                        match name {
                            $(Name::$variant => {
                                <$fields as serde::Deserialize>::deserialize(fields).map($choice::$variant)
                            })*
                        }
                    }
                }

                let names = &[$(stringify!($variant)),*];
                deserializer.deserialize_enum(stringify!($choice), names, Reader)
            }
        }
    };
}

pub(super) use struct_variants;
