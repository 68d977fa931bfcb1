//! Arguments and results of GL functions, whatever their type.

use std::ffi::c_void;

/// An argument, or a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    Nothing,
    Byte(u8),
    Unsigned(u32),
    Signed(i32),
    Size(isize),
    Float(f32),
    Double(f64),
    Pointer(*const c_void),
}

/// A type of GL's signatures.
pub trait Word: Sized {
    fn pack(self) -> Value;
    /// The number as this type; 0 or null of another kind.
    fn unpack(value: Value) -> Self;
}

impl Value {
    /// The number; 0 of a pointer.
    pub fn number(self) -> f64 {
        match self {
            Self::Nothing | Self::Pointer(_) => 0.0,
            Self::Byte(value) => f64::from(value),
            Self::Unsigned(value) => f64::from(value),
            Self::Signed(value) => f64::from(value),
            Self::Size(value) => value as f64,
            Self::Float(value) => f64::from(value),
            Self::Double(value) => value,
        }
    }

    /// The number in the kind of `self`.
    pub fn with(self, number: f64) -> Self {
        match self {
            Self::Nothing => Self::Nothing,
            Self::Byte(_) => Self::Byte(number as u8),
            // Masks come as -1 or as !0.
            Self::Unsigned(_) if number < 0.0 => Self::Unsigned(number as i32 as u32),
            Self::Unsigned(_) => Self::Unsigned(number as u32),
            Self::Signed(_) => Self::Signed(number as i64 as i32),
            Self::Size(_) => Self::Size(number as isize),
            Self::Float(_) => Self::Float(number as f32),
            Self::Double(_) => Self::Double(number),
            Self::Pointer(pointer) => Self::Pointer(pointer),
        }
    }
}

macro_rules! words {
    ($($type:ty: $kind:ident),*) => {
        $(impl Word for $type {
            fn pack(self) -> Value {
                Value::$kind(self)
            }

            fn unpack(value: Value) -> Self {
                match value {
                    Value::$kind(value) => value,
                    other => other.number() as $type,
                }
            }
        })*
    };
}

words!(u8: Byte, u32: Unsigned, i32: Signed, isize: Size, f32: Float, f64: Double);

impl Word for () {
    fn pack(self) -> Value {
        Value::Nothing
    }

    fn unpack(_: Value) {}
}

impl<T> Word for *const T {
    fn pack(self) -> Value {
        Value::Pointer(self.cast())
    }

    fn unpack(value: Value) -> Self {
        if let Value::Pointer(pointer) = value { pointer.cast() } else { std::ptr::null() }
    }
}

impl<T> Word for *mut T {
    fn pack(self) -> Value {
        Value::Pointer(self.cast_const().cast())
    }

    fn unpack(value: Value) -> Self {
        if let Value::Pointer(pointer) = value { pointer.cast_mut().cast() } else { std::ptr::null_mut() }
    }
}
