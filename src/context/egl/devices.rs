//! The machine's EGL devices (EGL_EXT_device_enumeration, EGL_EXT_device_query), by index.

use std::ffi::{CStr, c_char, c_void};

use khronos_egl as egl;
use serde::Serialize;

use super::api::{self, Egl};

/// EGLDeviceEXT.
pub(super) type RawDevice = *mut c_void;

const DRM_DEVICE_FILE_EXT: egl::Int = 0x3233;
const RENDERER_EXT: egl::Int = 0x335F;

/// One of the machine's devices, as `--device` counts them.
#[derive(Clone, Debug, Serialize)]
pub struct EglDevice {
    /// Place in EGL's list of devices, from 0.
    pub index: usize,
    /// The renderer's name if EGL gives it, else `software` or `hardware`.
    pub name: String,
    /// Mesa's software rasterizer (EGL_MESA_device_software).
    pub software: bool,
    /// The device's file, e.g. `/dev/dri/card0`.
    pub file: Option<String>,
    /// Names of the device's EGL extensions.
    pub extensions: Vec<String>,
}

/// All devices, in EGL's order, which is that of `--device`.
pub fn devices() -> Result<Vec<EglDevice>, String> {
    let egl = api::library()?;
    let raw = enumerate(egl)?;
    Ok(raw.into_iter().enumerate().map(|(index, device)| describe(egl, index, device)).collect())
}

/// The devices' handles, which live as long as the process.
pub(super) fn enumerate(egl: &Egl) -> Result<Vec<RawDevice>, String> {
    type QueryDevices = unsafe extern "system" fn(egl::Int, *mut RawDevice, *mut egl::Int) -> egl::Boolean;
    let address = api::address_of(egl, c"eglQueryDevicesEXT");
    let known = ["EGL_EXT_device_enumeration", "EGL_EXT_device_base"];
    if address.is_null() || !known.iter().any(|name| api::has_extension(egl, egl::NO_DISPLAY, name)) {
        return Err("EGL has no EGL_EXT_device_enumeration".to_owned());
    }
    let mut devices = [std::ptr::null_mut(); 64];
    let mut count = 0;
    // SAFETY: eglQueryDevicesEXT has this signature and writes at most as many handles as it is told.
    let answered = unsafe {
        let query_devices = std::mem::transmute::<*const c_void, QueryDevices>(address);
        query_devices(devices.len() as egl::Int, devices.as_mut_ptr(), &mut count)
    };
    if answered != egl::TRUE {
        return Err(api::failure(egl, "eglQueryDevicesEXT"));
    }
    let count = usize::try_from(count).unwrap_or(0).min(devices.len());
    Ok(devices[..count].to_vec())
}

fn describe(egl: &Egl, index: usize, device: RawDevice) -> EglDevice {
    let extensions = device_string(egl, device, egl::EXTENSIONS).unwrap_or_default();
    let extensions: Vec<String> = extensions.split_ascii_whitespace().map(str::to_owned).collect();
    let has = |name: &str| extensions.iter().any(|extension| extension == name);
    let software = has("EGL_MESA_device_software");
    let ask = |extension, name| has(extension).then(|| device_string(egl, device, name)).flatten();
    let kind = if software { "software" } else { "hardware" };
    EglDevice {
        index,
        name: ask("EGL_EXT_device_query_name", RENDERER_EXT).unwrap_or_else(|| kind.to_owned()),
        software,
        file: ask("EGL_EXT_device_drm", DRM_DEVICE_FILE_EXT),
        extensions,
    }
}

fn device_string(egl: &Egl, device: RawDevice, name: egl::Int) -> Option<String> {
    type QueryDeviceString = unsafe extern "system" fn(RawDevice, egl::Int) -> *const c_char;
    let address = api::address_of(egl, c"eglQueryDeviceStringEXT");
    if address.is_null() {
        return None;
    }
    // SAFETY: eglQueryDeviceStringEXT has this signature; the device is one that EGL named, and its strings are kept.
    unsafe {
        let query = std::mem::transmute::<*const c_void, QueryDeviceString>(address);
        let text = query(device, name);
        (!text.is_null()).then(|| CStr::from_ptr(text).to_string_lossy().into_owned())
    }
}
