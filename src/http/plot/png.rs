//! Pixels of a picture.

use crate::http::problem::Problem;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};
use std::sync::{Arc, LazyLock};

/// DejaVu Sans 2.37, the only letters there are: the machine may have none.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    Arc::new(fonts)
});

/// The picture of a document at its size.
pub(super) fn of(document: &str) -> Result<Vec<u8>, Problem> {
    let options = Options { fontdb: Arc::clone(&FONTS), ..Options::default() };
    let tree = Tree::from_str(document, &options).map_err(|error| broken(&error))?;
    let size = tree.size().to_int_size();
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or_else(|| broken(&"no size"))?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| broken(&error))
}

fn broken(error: &dyn std::fmt::Display) -> Problem {
    tracing::error!(%error, "a picture could not be made");
    Problem::internal()
}
