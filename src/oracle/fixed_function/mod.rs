//! The same passes that the device draws with shaders, through the driver's own fixed-function pipeline in a
//! compatibility context [GL 4.6 compatibility, 12 and 16]: the second reader of every pass list.

mod binding;

pub use binding::{Binding, BindingError, raw};
