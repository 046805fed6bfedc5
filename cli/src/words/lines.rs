//! Lines that are wider than the terminal: formulas, models and examples, which are not prose. Takes text in lines;
//! gives lines of at most a given number of characters. A line is broken before the signs of a sum if it has any, at
//! the least depth of brackets, and its continuation is indented.

/// The additional indentation of a continuation line.
const INDENT: usize = 4;

/// The cost of breaking one bracket deeper, as empty space in percent of a line.
const DEPTH_COST: usize = 60;

/// The cost of a break between words instead of before a sign, as empty space in percent of a line.
const SIGN_GAIN: usize = 50;

/// The first line of a text that is not empty.
pub(crate) fn first_line(doc: &str) -> String {
    let mut lines = doc.lines().map(str::trim);
    lines.find(|line| !line.is_empty()).unwrap_or("").to_owned()
}

/// The text with every line at most `width` characters long; lines are never joined.
pub(crate) fn fitted(text: &str, width: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        broken(line, width.max(1), &mut out);
    }
    out
}

fn broken(line: &str, width: usize, out: &mut String) {
    let mut letters: Vec<char> = line.chars().collect();
    if let Some(first) = letters.first()
        && letters.iter().all(|letter| letter == first)
    {
        // The rule below a heading.
        letters.truncate(width);
    }
    let own = letters.iter().take_while(|letter| **letter == ' ').count();
    // On a narrow terminal half of the line remains for words.
    let indent = (own + INDENT).min(width / 2);
    let mut depth = 0;
    while letters.len() > width {
        let start = letters.iter().take_while(|letter| **letter == ' ').count();
        let (cut, deep) = cut(&letters, start, width, depth);
        let rest = letters.split_off(cut);
        push(&letters, out);
        let rest = rest.into_iter().skip_while(|letter| *letter == ' ');
        letters = std::iter::repeat_n(' ', indent).chain(rest).collect();
        depth = deep;
    }
    push(&letters, out);
}

fn push(letters: &[char], out: &mut String) {
    let line: String = letters.iter().collect();
    out.push_str(line.trim_end());
    out.push('\n');
}

/// The best break: at a space after `start`, or in the middle of a word that is longer than a line; and the depth of
/// brackets there, if it is `depth` at the start.
fn cut(letters: &[char], start: usize, width: usize, depth: usize) -> (usize, usize) {
    let mut deep = depth;
    let mut best: Option<(usize, usize, usize)> = None;
    for (at, letter) in letters.iter().enumerate().take(width + 1) {
        match letter {
            '(' | '[' | '{' | '⟨' => deep += 1,
            ')' | ']' | '}' | '⟩' => deep = deep.saturating_sub(1),
            ' ' if at > start => {
                // Such signs start a line, and never end one.
                let next = letters.get(at + 1..).unwrap_or_default();
                let sign = begins_line(next.iter().take_while(|l| **l != ' '));
                let last = letters.get(..at).unwrap_or_default();
                let behind = begins_line(last.rsplit(|l| *l == ' ').next().unwrap_or_default());
                let words = if sign { 0 } else { SIGN_GAIN * width / 100 };
                let cost = (width - at) + DEPTH_COST * width / 100 * deep + words;
                // If costs are equal, the later position is taken.
                if !behind && best.is_none_or(|(least, ..)| cost <= least) {
                    best = Some((cost, at, deep));
                }
            }
            _ => {}
        }
    }
    best.map_or((width.max(start + 1), deep), |(_, at, deep)| (at, deep))
}

/// Whether a word is a sign between terms or sides.
fn begins_line<'a>(word: impl IntoIterator<Item = &'a char>) -> bool {
    let word: String = word.into_iter().collect();
    ["+", "-", "−", "=", ":=", "≡", "→", "≈"].contains(&word.as_str())
}

#[cfg(test)]
mod tests {
    use super::fitted;

    #[test]
    fn sums_are_broken_before_their_signs() {
        assert_eq!(
            fitted("  x = a + (b + c) - d\nshort\n", 15),
            "  x = a\n      + (b + c)\n      - d\nshort\n"
        );
        // Inside brackets only if necessary.
        assert_eq!(
            fitted("f(a + b + c + d + e)", 12),
            "f(a + b + c\n    + d + e)".to_owned() + "\n"
        );
        // Relations do so too.
        assert_eq!(fitted("abcd = ef", 8), "abcd\n    = ef\n");
        // The sign of a number stays with the number.
        assert_eq!(fitted("x = -a - -b", 8), "x = -a\n    - -b\n");
    }

    #[test]
    fn words_are_broken_where_there_is_no_sum() {
        assert_eq!(fitted("one two three", 9), "one two\n    three\n");
        assert_eq!(fitted("abcdefgh", 5), "abcde\n  fgh\n");
        assert_eq!(
            fitted("two words\n=========\n", 6),
            "two\n   wor\n   ds\n======\n"
        );
        assert_eq!(fitted("", 5), "");
        assert_eq!(fitted("\n\n", 5), "\n\n");
    }
}
