//! A picture for a paper as PDF, with its text set in a font of the machine. It needs the feature `pdf`, which
//! adds a hundred crates.

/// The picture of an SVG in its own size; `None` if the command is built without the feature.
///
/// # Errors
/// The reason why the picture cannot be converted, in a sentence.
#[cfg(not(feature = "pdf"))]
pub(super) fn pdf(_: &str) -> Option<Result<Vec<u8>, String>> {
    None
}

/// Families with Greek letters and mathematical signs; the first installed family is used.
#[cfg(feature = "pdf")]
const FAMILIES: [&str; 6] = [
    "Helvetica",
    "Arial",
    "DejaVu Sans",
    "Liberation Sans",
    "Noto Sans",
    "FreeSans",
];

/// The picture of an SVG in its own size; `None` if the command is built without the feature.
///
/// # Errors
/// The reason why the picture cannot be converted, in a sentence.
#[cfg(feature = "pdf")]
pub(super) fn pdf(svg: &str) -> Option<Result<Vec<u8>, String>> {
    Some(set(svg))
}

#[cfg(feature = "pdf")]
fn set(svg: &str) -> Result<Vec<u8>, String> {
    use svg2pdf::{ConversionOptions, PageOptions, usvg};
    let mut options = usvg::Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_system_fonts();
    let there = |family: &str| {
        let mut faces = fonts.faces();
        faces.any(|face| face.families.iter().any(|(name, _)| name == family))
    };
    let known = FAMILIES.into_iter().find(|family| there(family));
    let first = || {
        let (name, _) = fonts.faces().next()?.families.first()?;
        Some(name.clone())
    };
    let Some(family) = known.map(str::to_owned).or_else(first) else {
        return Err(
            "this machine has no font; install one, such as DejaVu Sans (fonts-dejavu-core)"
                .to_owned(),
        );
    };
    fonts.set_sans_serif_family(family);
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| e.to_string())?;
    // The resolution of SVG in pixels per inch: a column of 86 mm keeps its width.
    let page = PageOptions { dpi: 96.0 };
    svg2pdf::to_pdf(&tree, ConversionOptions::default(), page).map_err(|e| e.to_string())
}
