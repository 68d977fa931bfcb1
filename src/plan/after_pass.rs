//! A plan cut short behind one of its passes, to show how a picture of several passes comes about.

use super::{Error, Plan, prune};
use crate::pass::{Channels, Work};

impl Plan {
    /// The plan without what follows a pass, which `wanted` names: its number in `glumbra plan`, from 1, or its label. Views
    /// are left out.
    ///
    /// # Errors
    ///
    /// No such pass, or one before the first that draws into the picture.
    pub fn after_pass(mut self, wanted: &str) -> Result<Self, Error> {
        let passes = &self.list.passes;
        let by_number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        let found = by_number.filter(|index| *index < passes.len());
        let found = found.or_else(|| passes.iter().position(|pass| pass.label == wanted));
        let listed = |pictures: bool| {
            let listed =
                passes.iter().enumerate().filter(|(_, pass)| !pictures || pass.writes().contains(&self.picture));
            let words = listed.map(|(index, pass)| format!("{} \"{}\"", index + 1, pass.label));
            words.collect::<Vec<_>>().join(", ")
        };
        let Some(last) = found else {
            return Err(Error::NoPassAfter { wanted: wanted.to_owned(), names: listed(false) });
        };
        if !passes[..=last].iter().any(|pass| pass.writes().contains(&self.picture)) {
            let label = passes[last].label.clone();
            return Err(Error::BeforePicture { number: last + 1, label, names: listed(true) });
        }
        self.list.passes.truncate(last + 1);
        self.views.clear();
        prune::drop_unused_images(&mut self);
        Ok(self)
    }

    /// Tests whether the last pass writes alpha of the picture and no colour: what it draws is to be seen in alpha alone.
    pub fn ends_in_alpha(&self) -> bool {
        let last = self.list.passes.last().map(|pass| &pass.work);
        let writes_alpha = |work: &Work| matches!(work, Work::Draw(draw) if draw.target.color == Some(self.picture) && draw.state.color_write == Channels::Alpha);
        last.is_some_and(writes_alpha)
    }
}
