//! Characters that look like a Latin or Greek letter but are different: the micro sign, Cyrillic letters, letters of
//! other widths and styles. Takes a name; gives the name in plain letters.

use unicode_normalization::UnicodeNormalization;

/// Letters whose compatibility form looks different; they remain separate names.
const OWN: &str = "ϵϑϕϖϱςℓ";

/// Pairs of a letter and the one that it looks like: Cyrillic, Armenian, phonetic.
const TWINS: &str = "аaеeоoрpсcуyхxѕsіiјjһhԁdԛqԝwӏlүyАAВBЕEКKМMНHОOРPСCТTУYХXЅSІIЈJԌGԚQԜWҮY\
                     ГΓПΠФΦЛΛфφпπ\
                     օoսuհhոnցgԱUՕOՍUՏSԼL\
                     ıiȷjɑαɡgɩιɛεɣγɸφʋυßβꞵβꭓχɪIᴄcᴏoᴠvᴡwᴢzℎhϳj";

/// The letter that a character looks like, if it is not that letter itself.
pub(crate) fn twin(c: char) -> Option<char> {
    if c.is_ascii() {
        return None;
    }
    let mut rest = TWINS.chars();
    while let (Some(letter), Some(other)) = (rest.next(), rest.next()) {
        if letter == c {
            return Some(other);
        }
    }
    let plain = plain(c).next().filter(|_| plain(c).count() == 1)?;
    (plain != c).then_some(plain)
}

/// A character in its compatibility form. Blackboard letters and similar ones print differently, so they are replaced
/// only if they are the same letter by definition.
fn plain(c: char) -> impl Iterator<Item = char> {
    let own = c.is_ascii() || OWN.contains(c);
    let styled = ('\u{2100}'..='\u{214f}').contains(&c);
    let text: String = match (own, styled) {
        (true, _) => c.to_string(),
        (_, true) => c.to_string().nfc().collect(),
        _ => c.to_string().nfkd().collect(),
    };
    text.chars().collect::<Vec<_>>().into_iter()
}

/// A name with every such character replaced by the letter that it looks like.
pub(crate) fn skeleton(name: &str) -> String {
    if name.is_ascii() {
        return name.to_owned();
    }
    let letters = name.chars().flat_map(|c| match twin(c) {
        Some(other) => vec![other],
        None => plain(c).collect(),
    });
    letters.nfc().collect()
}
