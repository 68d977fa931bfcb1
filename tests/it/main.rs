//! Everything that is tested through the library and the commands, in one program: it is linked once, and tests of
//! different modules run side by side. No test changes the environment or the current folder of the process: what needs
//! others runs the command in a process of its own.

mod acne;
mod after_pass;
mod alpha_shadows;
mod architecture;
mod bad_scenes;
mod check;
mod claims;
mod cli;
mod contexts;
mod coverage;
mod doc_comments;
mod documents;
mod doubt;
mod dust;
mod extremes;
#[cfg(unix)]
mod faults;
mod figures;
mod fit;
mod fixed_function;
mod floor;
mod focus;
mod generated;
mod geometry_files;
mod guards;
mod hw_shadowmaps_simple;
mod hw_woo_shadowmaps;
mod independent;
mod kernels;
mod layers;
mod left_out;
mod licences;
mod light_maps;
mod light_reports;
mod listing_drawn;
mod many_lights;
mod mistakes;
mod mutated;
mod oracle;
mod placement;
mod plan_listings;
mod planes;
mod projected;
mod ranges;
mod redraw;
mod report;
mod scenes;
#[cfg(unix)]
mod setup;
mod shaders;
mod shadow_settings;
mod slides;
mod stencil;
mod stress;
mod suns;
mod support;
mod tags;
mod viewer;
mod volume_warnings;
mod volumes;
mod waves;
