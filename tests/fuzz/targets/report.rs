//! report.json: what is read back is merged with itself and shown.
#![no_main]

use glumbra::report::measure::picks::Goals;
use glumbra::report::show::html::{ReportPictures, to_html};
use glumbra::report::store::{csv, merge};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = glumbra_fuzz::file("report.json", bytes);
    let Ok(report) = merge::load(&path) else { return };
    let parts = vec![(path.clone(), report.clone()), (path, report)];
    if let Ok(report) = merge::merge(parts) {
        let _ = csv::to_csv(&report);
        let _ = to_html(&report, &ReportPictures::default(), &Goals::default());
    }
});
