//! `glumbra info`.
use super::{ContextArgs, Error};
use crate::context::{self, Profile};
#[derive(Clone, Debug, clap::Args)]
pub(super) struct InfoArgs {
    #[command(flatten)]
    context: ContextArgs,
}
pub(super) fn run(a: &InfoArgs) -> Result<(), Error> {
    let t = std::time::Instant::now();
    let c = context::open(&a.context.request(Profile::Core33))?;
    println!("{:?}", t.elapsed());
    println!("{:#?}", c.describe());
    Ok(())
}
