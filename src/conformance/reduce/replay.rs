//! Recorded calls, made again in another context.

use std::collections::HashMap;
use std::ffi::{CString, c_void};

use super::log::{Argument, Recorded};
use super::meaning::Kind;
use crate::conformance::layer::functions;
use crate::conformance::layer::value::Value;
use crate::context::Context;

/// Answer of the driver to the last read, and GL's error.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    pub bytes: Vec<u8>,
    pub error: u32,
}

/// Makes the calls in a new context, which is current; the answer to the last.
pub fn replay(context: &dyn Context, calls: &[&Recorded]) -> Replayed {
    let mut names: HashMap<(Kind, usize), u32> = HashMap::new();
    let mut answer = Vec::new();
    let Some((last, before)) = calls.split_last() else { return Replayed { bytes: answer, error: 0 } };
    for call in before {
        make(context, call, &mut names);
    }
    // The read itself may be of the error.
    let error = if last.name == "glGetError" { 0 } else { context_error(context) };
    if let Some(bytes) = make(context, last, &mut names) {
        answer = bytes;
    }
    let after = if last.name == "glGetError" { 0 } else { context_error(context) };
    Replayed { bytes: answer, error: if error == 0 { after } else { error } }
}

fn context_error(context: &dyn Context) -> u32 {
    use glow::HasContext;
    // SAFETY: the context is current.
    unsafe { context.gl().get_error() }
}

/// Makes one call; what it answered.
fn make(context: &dyn Context, call: &Recorded, names: &mut HashMap<(Kind, usize), u32>) -> Option<Vec<u8>> {
    let (name, invoke) = functions::invoke_of(call.name)?;
    let address = CString::new(name).map_or(std::ptr::null(), |name| context.address_of(&name));
    if address.is_null() {
        return None;
    }
    let texts: Vec<Option<CString>> = call
        .arguments
        .iter()
        .map(|argument| if let Argument::Text(text) = argument { CString::new(text.as_str()).ok() } else { None })
        .collect();
    let pointers: Vec<*const c_void> =
        texts.iter().map(|text| text.as_ref().map_or(std::ptr::null(), |text| text.as_ptr().cast())).collect();
    let mut out: Vec<u64> = Vec::new();
    let mut length = None;
    let mut arguments = Vec::new();
    for (index, argument) in call.arguments.iter().enumerate() {
        arguments.push(match argument {
            Argument::Number(value) => *value,
            Argument::Enum(value) | Argument::Bits(value) => Value::Unsigned(*value),
            Argument::Object(kind, number) => Value::Unsigned(names.get(&(*kind, *number)).copied().unwrap_or(0)),
            Argument::Location(number) => {
                let location = names.get(&(Kind::Location, *number)).copied();
                Value::Signed(location.map_or(-1, |location| location as i32))
            }
            Argument::Data(data) => Value::Pointer(data.bytes.as_ptr().cast()),
            // glShaderSource takes the place of a pointer to the text.
            Argument::Text(_) if call.name == "glShaderSource" => Value::Pointer((&raw const pointers[index]).cast()),
            Argument::Text(_) => Value::Pointer(pointers[index]),
            Argument::Offset(offset) => Value::Pointer(*offset as *const c_void),
            Argument::Out(bytes) => {
                out = vec![0; bytes.div_ceil(8) + 8];
                length = Some(*bytes);
                Value::Pointer(out.as_mut_ptr().cast_const().cast())
            }
            Argument::Null => Value::Pointer(std::ptr::null()),
        });
    }
    if call.name == "glShaderSource"
        && let Some(count) = arguments.get_mut(1)
    {
        *count = Value::Signed(1);
    }
    // SAFETY: the arguments are those of a call that was made, with their memory; the address is the function's.
    let result = unsafe { invoke(address, &arguments) };
    let bytes: Vec<u8> = out.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let is_made_by_result = call.name.starts_with("glCreate") || call.name == "glGetUniformLocation";
    for (index, (kind, number)) in call.made.iter().enumerate() {
        let name = match is_made_by_result {
            true => result.number() as i64 as u32,
            false => bytes
                .get(4 * index..4 * index + 4)
                .and_then(|four| four.first_chunk())
                .map_or(0, |four| u32::from_ne_bytes(*four)),
        };
        names.insert((*kind, *number), name);
    }
    call.read?;
    Some(match length {
        Some(length) => bytes[..length].to_vec(),
        None => (result.number() as u32).to_ne_bytes().to_vec(),
    })
}
