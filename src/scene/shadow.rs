//! `[light.shadow]` of a light: as it is written, and as a shadow technique has read it when the scene was loaded. What a
//! technique has read is opaque here, because techniques stand above scenes.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use super::Settings;

/// Shadow settings of a light. Clones share what was read.
#[derive(Clone)]
pub struct Shadow {
    written: Settings,
    read: Arc<dyn Any + Send + Sync>,
}

impl Shadow {
    /// The table `written`, and the settings that were read from it.
    pub fn new<T: Any + Send + Sync>(written: Settings, read: T) -> Self {
        Self { written, read: Arc::new(read) }
    }

    /// The table as written, to be printed, compared or changed. Empty where the light has no `[light.shadow]`.
    pub fn written(&self) -> &Settings {
        &self.written
    }

    /// The settings that were read; `None` if they are of another type.
    pub fn settings<T: Any>(&self) -> Option<&T> {
        self.read.downcast_ref()
    }
}

impl fmt::Debug for Shadow {
    /// The table as written: settings that were read follow from it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Shadow").field(&self.written).finish()
    }
}
