//! Breaks a displayed formula into lines: at every relation after the first, then before signs in the longest parts,
//! with the outermost brackets first. Text and typeset formats share this algorithm.

use super::layout::{Fence, Layout, Sign, Strength};

/// A piece of a line. Opening and closing brackets are separate, so that a line may end inside them.
#[derive(Clone, Debug)]
pub(super) enum Piece<'a> {
    /// A layout that is not broken.
    Whole(&'a Layout),
    /// An opening bracket; `true` if its content is taller than a line.
    Open(Fence, bool),
    /// A closing bracket.
    Close(Fence, bool),
    /// A possible break at this depth of brackets.
    Break(Strength, usize),
}

/// A line.
#[derive(Clone, Debug)]
pub(super) struct Line<'a> {
    /// The depth of brackets at which it starts.
    pub depth: usize,
    /// Whether it starts at a relation sign.
    pub relation: bool,
    /// Its pieces.
    pub pieces: Vec<Piece<'a>>,
}

/// A formula in lines.
#[derive(Clone, Debug)]
pub(super) struct Lines<'a> {
    /// The left side before the first relation sign; empty if the lines are not aligned to one.
    pub left: Vec<Piece<'a>>,
    /// The lines.
    pub lines: Vec<Line<'a>>,
}

/// The cost of each further bracket level, as unused width in percent of a line.
const DEPTH_COST: usize = 30;

/// A segment counts as short if it takes at most `1 / SHORT_END` of a line.
const SHORT_END: usize = 8;

/// How a format measures its lines, in its own units.
pub(super) struct Ruler<'r> {
    /// The maximum width of a line.
    pub limit: usize,
    /// The width of a piece.
    pub measure: &'r dyn Fn(&Piece) -> usize,
    /// The indentation of a continuation line at a depth of brackets, and aligned to a relation or not.
    pub indent: &'r dyn Fn(usize, bool) -> usize,
}

/// Breaks the formula into lines; `None` if it fits on one.
pub(super) fn broken<'a>(layout: &'a Layout, ruler: &Ruler) -> Option<Lines<'a>> {
    let (limit, measure) = (ruler.limit, ruler.measure);
    let mut pieces = Vec::new();
    flatten(layout, 0, &mut pieces);
    let width = |part: &[Piece]| part.iter().map(measure).sum::<usize>();
    if width(&pieces) <= limit {
        return None;
    }
    let is_relation = |p: &Piece| matches!(p, Piece::Break(Strength::Relation, 0));
    let mut segments: Vec<Vec<Piece>> = vec![Vec::new()];
    for piece in pieces {
        if is_relation(&piece) {
            segments.push(Vec::new());
        } else if let Some(last) = segments.last_mut() {
            last.push(piece);
        }
    }
    // A left side wider than half a line does not leave room for alignment.
    let aligned = segments.len() > 1 && segments.first().is_some_and(|s| width(s) <= limit / 2);
    let left = if aligned {
        segments.remove(0)
    } else {
        Vec::new()
    };
    let room = limit.saturating_sub(width(&left)).max(limit / 3);
    let mut lines: Vec<Line> = Vec::new();
    for (i, segment) in segments.into_iter().enumerate() {
        let relation = aligned || i > 0;
        // A short end such as `= 0` stays on the line if there is room.
        let needed = width(&segment);
        if let Some(last) = lines.last_mut()
            && needed <= limit / SHORT_END
            && width(&last.pieces) + needed <= room
        {
            last.pieces.extend(segment);
            continue;
        }
        let at = Segment {
            relation,
            aligned,
            room,
        };
        split(segment, &at, ruler, &mut lines);
    }
    Some(Lines { left, lines })
}

/// Breaks the formula into lines of this many points, indented by one quad and another for each bracket level.
pub(super) fn typeset(layout: &Layout, points: usize) -> Option<Lines<'_>> {
    within(layout, 10 * points)
}

/// Like `typeset`, with the limit in tenths of a point.
fn within(layout: &Layout, limit: usize) -> Option<Lines<'_>> {
    let ruler = Ruler {
        limit,
        measure: &|p| p.width(),
        indent: &|depth, _| 100 * (depth + 1),
    };
    broken(layout, &ruler)
}

/// A left side is too wide for the other relation signs to align with its own if it takes more than `1 / WIDE_LEFT`
/// of a line.
const WIDE_LEFT: usize = 4;

/// Breaks relations into lines of this many points with aligned relation signs. A relation with a wide left side
/// begins where the right sides of the others begin.
pub(super) fn group(layouts: &[Layout], points: usize) -> Vec<Lines<'_>> {
    let limit = 10 * points;
    let width = |pieces: &[Piece]| pieces.iter().map(Piece::width).sum::<usize>();
    let sides = layouts.iter().map(|layout| {
        let mut left = Vec::new();
        flatten(layout, 0, &mut left);
        let sign = left.iter().position(Piece::is_relation);
        let right = left.split_off(sign.unwrap_or(0));
        (layout, left, right)
    });
    let sides: Vec<_> = sides.collect();
    let narrow = |left: &[Piece]| width(left) <= limit / WIDE_LEFT;
    let lefts = sides.iter().map(|(_, left, _)| left).filter(|l| narrow(l));
    let widest = lefts.map(|l| width(l)).max().unwrap_or(0);
    let one = |left, pieces| Lines {
        left,
        lines: vec![Line {
            depth: 0,
            relation: true,
            pieces,
        }],
    };
    let placed = sides.into_iter().map(|(layout, left, right)| {
        if narrow(&left) {
            let room = limit.saturating_sub(widest - width(&left));
            return within(layout, room).unwrap_or_else(|| one(left, right));
        }
        let Some(mut broken) = within(layout, limit.saturating_sub(widest)) else {
            return one(Vec::new(), left.into_iter().chain(right).collect());
        };
        let start = std::mem::take(&mut broken.left);
        if let Some(first) = broken.lines.first_mut() {
            first.pieces.splice(0..0, start);
        }
        broken
    });
    placed.collect()
}

fn flatten<'a>(layout: &'a Layout, depth: usize, out: &mut Vec<Piece<'a>>) {
    match layout {
        Layout::Row(parts) => parts.iter().for_each(|p| flatten(p, depth, out)),
        Layout::Fenced(fence, inner) => {
            let tall = inner.is_tall();
            out.push(Piece::Open(*fence, tall));
            flatten(inner, depth + 1, out);
            out.push(Piece::Close(*fence, tall));
        }
        Layout::Break(strength) => out.push(Piece::Break(*strength, depth)),
        Layout::Identifier(_)
        | Layout::Typeset(..)
        | Layout::Number(_)
        | Layout::Word(_)
        | Layout::Text(_)
        | Layout::Sign(_)
        | Layout::Script { .. }
        | Layout::Fraction(..)
        | Layout::Root(_)
        | Layout::Hat(_)
        | Layout::Grid(_) => out.push(Piece::Whole(layout)),
    }
}

/// The position of a segment.
struct Segment {
    relation: bool,
    aligned: bool,
    room: usize,
}

/// Breaks one segment greedily, at the cheapest break that fits.
fn split<'a>(mut rest: Vec<Piece<'a>>, at: &Segment, ruler: &Ruler, out: &mut Vec<Line<'a>>) {
    let (mut depth, mut relation, mut room) = (0, at.relation, at.room);
    loop {
        let mut used = 0;
        let mut best: Option<(usize, usize, usize)> = None;
        for (i, piece) in rest.iter().enumerate() {
            used += (ruler.measure)(piece);
            if let Piece::Break(strength, deep) = piece
                && i > 0
            {
                // Breaking within a product is a last resort.
                let torn = match strength {
                    Strength::Factor => ruler.limit / 2,
                    Strength::Relation | Strength::Term => 0,
                };
                // On the line, a later break is better; beyond its end, an earlier one.
                let empty = if used <= room {
                    room - used
                } else {
                    100 * ruler.limit + used
                };
                let cost = DEPTH_COST * ruler.limit / 100 * deep + empty + torn;
                if best.is_none_or(|(c, ..)| cost <= c) {
                    best = Some((cost, i, *deep));
                }
            }
        }
        let (cut, next_depth) = match best {
            Some((_, cut, deep)) if used > room => (cut, deep),
            _ => {
                out.push(Line {
                    depth,
                    relation,
                    pieces: rest,
                });
                return;
            }
        };
        let tail = rest.split_off(cut + 1);
        rest.pop();
        out.push(Line {
            depth,
            relation,
            pieces: rest,
        });
        (rest, depth, relation) = (tail, next_depth, false);
        room = at.room.saturating_sub((ruler.indent)(depth, at.aligned));
    }
}

impl Piece<'_> {
    /// Whether it is a relation sign.
    pub fn is_relation(&self) -> bool {
        matches!(self, Piece::Whole(Layout::Sign(Sign::Relation(_))))
    }
}

/// Splits the pieces at the bracket that closes the one opened just before them: those inside and those after. `None`
/// if the bracket closes on another line.
pub(super) fn enclosed<'p, 'a>(
    rest: &'p [Piece<'a>],
) -> Option<(&'p [Piece<'a>], &'p [Piece<'a>])> {
    let mut depth = 0usize;
    let end = rest.iter().position(|p| {
        match p {
            Piece::Open(..) => depth += 1,
            Piece::Close(..) if depth == 0 => return true,
            Piece::Close(..) => depth -= 1,
            Piece::Whole(_) | Piece::Break(..) => {}
        }
        false
    })?;
    let (inside, after) = rest.split_at_checked(end)?;
    Some((inside, after.split_first()?.1))
}
