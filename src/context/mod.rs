//! A current GL context behind one trait: EGL, OSMesa or a window's.
