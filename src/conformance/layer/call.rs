//! One call of a GL function, on its way to the driver: what a fault may look at and change.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::{CStr, CString, c_void};
use std::rc::{Rc, Weak};

use super::groups::whole;
use super::value::{Value, Word};

/// Calls the function at an address with arguments of its signature.
pub type Invoke = unsafe fn(*const c_void, &[Value]) -> Value;

/// Act at a call.
pub type Act = fn(&mut Call);

/// Functions, and what is done at each call of one of them. `draw` stands for those that draw from arrays, `drawn` for glEnd
/// too, before which no state may be asked; `clear` for all that clear, `copy` for all that copy from a framebuffer.
pub type Hook = (&'static [&'static str], Act);

/// Names of functions, and the act at each call of one of them.
type OwnHook = (Vec<&'static str>, Box<dyn Fn(&mut Call)>);

/// Memory of a context with a fault, from call to call.
pub struct Layer {
    hooks: Vec<OwnHook>,
    /// The driver's own functions.
    gl: Rc<glow::Context>,
    invoke_of: fn(&str) -> Option<(&'static str, Invoke)>,
    address_of: Box<dyn Fn(&CStr) -> *const c_void>,
    addresses: RefCell<HashMap<&'static str, *const c_void>>,
    numbers: RefCell<HashMap<(u32, u32), f64>>,
    lists: RefCell<HashMap<(u32, u32), Vec<f32>>>,
    held: RefCell<Vec<Held>>,
    /// The layer that was current as this one was made: calls go on through it.
    beneath: Weak<Layer>,
}

/// A call that has not reached the driver yet.
#[derive(Clone)]
struct Held {
    name: &'static str,
    invoke: Invoke,
    arguments: Vec<Value>,
}

impl Layer {
    /// `gl` and `address_of` are the driver's own; `invoke_of` knows how each function is called.
    pub fn new(
        gl: Rc<glow::Context>,
        address_of: impl Fn(&CStr) -> *const c_void + 'static,
        invoke_of: fn(&str) -> Option<(&'static str, Invoke)>,
    ) -> Self {
        Self {
            hooks: Vec::new(),
            gl,
            invoke_of,
            address_of: Box::new(address_of),
            addresses: RefCell::default(),
            numbers: RefCell::default(),
            lists: RefCell::default(),
            held: RefCell::default(),
            beneath: CURRENT.with(|current| current.borrow().clone()),
        }
    }

    /// Has `act` done at each call of `functions`.
    pub fn hook(&mut self, functions: &[&'static str], act: impl Fn(&mut Call) + 'static) {
        self.hooks.push((whole(functions), Box::new(act)));
    }

    /// Tests whether a function is changed.
    pub fn changes(&self, function: &str) -> bool {
        self.hooks.iter().any(|(functions, _)| functions.contains(&function))
    }

    fn address(&self, name: &'static str) -> *const c_void {
        *self
            .addresses
            .borrow_mut()
            .entry(name)
            .or_insert_with(|| CString::new(name).map_or(std::ptr::null(), |name| (self.address_of)(&name)))
    }
}

thread_local! {
    /// The layer whose context is current on this thread.
    static CURRENT: RefCell<Weak<Layer>> = const { RefCell::new(Weak::new()) };
}

/// Makes a layer the one that this thread's calls go through.
pub fn make_current(layer: &Rc<Layer>) {
    CURRENT.with(|current| *current.borrow_mut() = Rc::downgrade(layer));
}

/// Tests whether this thread's calls go through the layer.
pub fn is_current(layer: &Rc<Layer>) -> bool {
    CURRENT.with(|current| std::ptr::eq(current.borrow().as_ptr(), Rc::as_ptr(layer)))
}

/// A call on its way.
pub struct Call<'a> {
    /// The function's name: one act may serve several.
    pub name: &'static str,
    /// Answer of the driver, after [`now`](Self::now).
    pub result: Value,
    layer: &'a Layer,
    arguments: Vec<Value>,
    invoke: Invoke,
    done: bool,
    /// Lists that replaced the caller's, until the call is over.
    kept: Vec<Box<[f32]>>,
}

/// Takes a call through the current layer; the driver's answer.
pub fn dispatch(name: &'static str, arguments: &[Value], invoke: Invoke) -> Value {
    let Some(layer) = CURRENT.with(|current| current.borrow().upgrade()) else { return Value::Nothing };
    let mut call = Call {
        name,
        result: Value::Nothing,
        layer: &layer,
        arguments: arguments.to_vec(),
        invoke,
        done: false,
        kept: Vec::new(),
    };
    let set = |to: Weak<Layer>| CURRENT.with(|current| *current.borrow_mut() = to);
    set(layer.beneath.clone());
    for (_, act) in layer.hooks.iter().filter(|(functions, _)| functions.contains(&name)) {
        act(&mut call);
    }
    call.now();
    set(Rc::downgrade(&layer));
    call.result
}

impl Call<'_> {
    /// An argument as GL's unsigned integer or enum.
    pub fn u(&self, index: usize) -> u32 {
        match self.arguments.get(index) {
            Some(Value::Signed(value)) => *value as u32,
            Some(value) => value.number() as u32,
            None => 0,
        }
    }

    /// All arguments.
    pub fn arguments(&self) -> &[Value] {
        &self.arguments
    }

    /// An argument as a signed integer.
    pub fn i(&self, index: usize) -> i32 {
        match self.arguments.get(index) {
            Some(Value::Unsigned(value)) => *value as i32,
            Some(value) => value.number() as i32,
            None => 0,
        }
    }

    /// An argument as a float.
    pub fn f(&self, index: usize) -> f64 {
        self.arguments.get(index).map_or(0.0, |value| value.number())
    }

    /// Replaces an argument.
    pub fn set(&mut self, index: usize, value: impl Into<f64>) {
        if let Some(argument) = self.arguments.get_mut(index) {
            *argument = argument.with(value.into());
        }
    }

    /// Puts `to` where an argument is `from`; tests whether it was.
    pub fn replace(&mut self, index: usize, from: u32, to: u32) -> bool {
        let is = self.u(index) == from;
        if is {
            self.set(index, to);
        }
        is
    }

    /// Exchanges two values of one argument.
    pub fn exchange(&mut self, index: usize, one: u32, other: u32) {
        if !self.replace(index, one, other) {
            self.replace(index, other, one);
        }
    }

    /// Exchanges two arguments.
    pub fn swap(&mut self, one: usize, other: usize) {
        if one.max(other) < self.arguments.len() {
            self.arguments.swap(one, other);
        }
    }

    /// Keeps the call from the driver.
    pub fn skip(&mut self) {
        self.done = true;
    }

    /// Makes the call, if it was neither made nor skipped: what follows sees its effect.
    pub fn now(&mut self) {
        if !std::mem::replace(&mut self.done, true) {
            self.result = self.again();
        }
    }

    /// Makes the call, whether or not it was made.
    pub fn again(&self) -> Value {
        let address = self.layer.address(self.name);
        if address.is_null() {
            return Value::Nothing;
        }
        // SAFETY: `invoke` was made for the signature of the function that is called so.
        unsafe { (self.invoke)(address, &self.arguments) }
    }

    /// The first `count` floats that an argument points to; none where it is null.
    pub fn floats(&self, index: usize, count: usize) -> Vec<f32> {
        self.read(index, count)
    }

    /// The first `count` integers that an argument points to; none where it is null.
    pub fn integers(&self, index: usize, count: usize) -> Vec<i32> {
        self.read(index, count)
    }

    /// The first `count` bytes that an argument points to; none where it is null, or pixels that do not lie there row by row.
    pub fn bytes(&self, index: usize, count: usize) -> Vec<u8> {
        if self.has_plain_pixels() { self.read(index, count) } else { Vec::new() }
    }

    fn read<T: Copy>(&self, index: usize, count: usize) -> Vec<T> {
        match self.arguments.get(index) {
            // SAFETY: a fault asks for no more than GL itself reads or has written there.
            Some(Value::Pointer(at)) if !at.is_null() => unsafe {
                (0..count).map(|item| at.cast::<T>().add(item).read_unaligned()).collect()
            },
            _ => Vec::new(),
        }
    }

    /// Writes what the caller reads after the call.
    pub fn write<T: Copy>(&mut self, index: usize, values: &[T]) {
        if !self.has_plain_pixels() {
            return;
        }
        if let Some(Value::Pointer(at)) = self.arguments.get(index)
            && !at.is_null()
        {
            for (item, value) in values.iter().enumerate() {
                // SAFETY: the caller passed the pointer for GL to write as many values to.
                unsafe { at.cast_mut().cast::<T>().add(item).write_unaligned(*value) };
            }
        }
    }

    /// Gives the driver other floats in place of those that an argument points to.
    pub fn set_floats(&mut self, index: usize, values: Vec<f32>) {
        let values = values.into_boxed_slice();
        self.set_pointer(index, values.as_ptr().cast());
        self.kept.push(values);
    }

    /// Gives the driver other bytes in place of those that an argument points to.
    pub fn set_bytes(&mut self, index: usize, values: &[u8]) {
        let mut padded = values.to_vec();
        padded.resize(values.len().div_ceil(4) * 4, 0);
        let words = padded.chunks_exact(4).map(|four| f32::from_ne_bytes([four[0], four[1], four[2], four[3]]));
        self.set_floats(index, words.collect());
    }

    /// An argument that is a pointer; null otherwise.
    pub fn pointer(&self, index: usize) -> *const c_void {
        self.arguments.get(index).map_or(std::ptr::null(), |value| Word::unpack(*value))
    }

    /// Replaces a pointer; what it points to must outlive the call.
    pub fn set_pointer(&mut self, index: usize, pointer: *const c_void) {
        if let Some(argument @ Value::Pointer(_)) = self.arguments.get_mut(index) {
            *argument = Value::Pointer(pointer);
        }
    }

    /// The driver's own functions: no fault is in them.
    pub fn gl(&self) -> &glow::Context {
        &self.layer.gl
    }

    /// Calls another function of the driver's own with numbers.
    pub fn other(&self, name: &str, numbers: &[f64]) {
        let Some((name, invoke)) = (self.layer.invoke_of)(name) else { return };
        let address = self.layer.address(name);
        let arguments: Vec<_> = numbers.iter().map(|number| Value::Double(*number)).collect();
        if !address.is_null() {
            // SAFETY: `invoke` is of this function, and makes the numbers its arguments.
            unsafe { invoke(address, &arguments) };
        }
    }

    /// Makes the call while something is on or off.
    pub fn with(&mut self, what: u32, on: bool) {
        let was = self.enabled(what);
        let switch = |on| self.other(if on { "glEnable" } else { "glDisable" }, &[f64::from(what)]);
        switch(on);
        self.now();
        let switch = |on| self.other(if on { "glEnable" } else { "glDisable" }, &[f64::from(what)]);
        switch(was);
    }

    /// Adds to an argument.
    pub fn add(&mut self, index: usize, value: f64) {
        let number = self.arguments.get(index).map_or(0.0, |argument| argument.number());
        self.set(index, number + value);
    }

    /// A number that was kept; 0 if none was.
    pub fn kept(&self, key: (u32, u32)) -> f64 {
        self.layer.numbers.borrow().get(&key).copied().unwrap_or(0.0)
    }

    /// Keeps a number for later calls.
    pub fn keep(&mut self, key: (u32, u32), value: impl Into<f64>) {
        self.layer.numbers.borrow_mut().insert(key, value.into());
    }

    /// Keeps a list for later calls, and gives what was kept before.
    pub fn keep_list(&mut self, key: (u32, u32), values: Vec<f32>) -> Option<Vec<f32>> {
        self.layer.lists.borrow_mut().insert(key, values)
    }

    /// Holds the call back until [`release`](Self::release). A call with pointers goes on at once.
    pub fn hold(&mut self) {
        if self.arguments.iter().any(|argument| matches!(argument, Value::Pointer(_))) {
            return;
        }
        let held = Held { name: self.name, invoke: self.invoke, arguments: self.arguments.clone() };
        self.layer.held.borrow_mut().push(held);
        self.skip();
    }

    /// Makes this call, then those that were held back.
    pub fn release(&mut self) {
        self.now();
        for Held { name, invoke, arguments } in self.layer.held.take() {
            let address = self.layer.address(name);
            if !address.is_null() {
                // SAFETY: as in `again`.
                unsafe { invoke(address, &arguments) };
            }
        }
    }
}
