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

#[cfg(test)]
mod tests {
    use super::of;

    /// What the pictures may write besides ASCII.
    const SYMBOLS: &str = "θσαλρφγµ°′−⁰¹²³⁴⁵⁶⁷⁸⁹⁻×·…±²—–";

    fn picture(letter: &str, weight: &str) -> Vec<u8> {
        let text =
            format!("<text x=\"5\" y=\"30\" font-size=\"30\" font-weight=\"{weight}\">{letter}</text>");
        let font = crate::http::plot::style::FONT;
        of(&format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"40\" font-family=\"{font}\" fill=\"#000\">{text}</svg>"
        ))
        .unwrap()
    }

    #[test]
    fn every_letter_has_its_own_shape() {
        let unknown = picture("\u{e000}", "normal");
        for letter in SYMBOLS.chars().chain((b'!'..=b'~').map(char::from)) {
            let letter = match letter {
                '<' => "&lt;".to_owned(),
                '&' => "&amp;".to_owned(),
                other => other.to_string(),
            };
            let drawn = picture(&letter, "normal");
            assert_ne!(drawn, picture(" ", "normal"), "{letter} is not drawn");
            assert_ne!(drawn, unknown, "{letter} is a box");
            assert_ne!(drawn, picture(&letter, "bold"), "{letter} is never bold");
        }
    }
}
