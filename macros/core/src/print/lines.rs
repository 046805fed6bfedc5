//! Breaking a displayed formula into lines: at every further relation, then before the signs of
//! the longest parts, least deep in brackets first. The same for text and for typeset formats.

use super::layout::{Fence, Layout, Sign, Strength};

/// What a line is made of: brackets are opened, so that a line may end inside them.
#[derive(Clone, Debug)]
pub(super) enum Piece<'a> {
    /// Something that is not broken.
    Whole(&'a Layout),
    /// An opening bracket; `true` around something higher than a line.
    Open(Fence, bool),
    /// A closing bracket.
    Close(Fence, bool),
    /// A place to break, this deep in brackets.
    Break(Strength, usize),
}

/// A line.
#[derive(Clone, Debug)]
pub(super) struct Line<'a> {
    /// How deep in brackets it starts.
    pub depth: usize,
    /// Whether it starts at a relation sign.
    pub relation: bool,
    /// Its pieces.
    pub pieces: Vec<Piece<'a>>,
}

/// A formula in lines.
#[derive(Clone, Debug)]
pub(super) struct Lines<'a> {
    /// What stands before the first relation sign; empty if the lines are not aligned to one.
    pub left: Vec<Piece<'a>>,
    /// The lines.
    pub lines: Vec<Line<'a>>,
}

/// What one bracket more is worth in empty line, in percent of a line.
const DEPTH_COST: usize = 30;

/// Which part of a line is short.
const SHORT_END: usize = 8;

/// How a format measures its lines, in units of its own.
pub(super) struct Ruler<'r> {
    /// The widest line.
    pub limit: usize,
    /// The width of a piece.
    pub measure: &'r dyn Fn(&Piece) -> usize,
    /// What a line that goes on is indented, this deep in brackets, aligned to a relation or not.
    pub indent: &'r dyn Fn(usize, bool) -> usize,
}

/// The formula in lines; `None` if it fits on one.
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
    // A left side beyond half a line leaves no room to align to.
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
        // A short end such as `= 0` stays on the line where there is room.
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

/// The formula in lines of so many points, indented by a quad for each bracket and one more.
pub(super) fn typeset(layout: &Layout, points: usize) -> Option<Lines<'_>> {
    within(layout, 10 * points)
}

/// The same in tenths of a point.
fn within(layout: &Layout, limit: usize) -> Option<Lines<'_>> {
    let ruler = Ruler {
        limit,
        measure: &|p| p.width(),
        indent: &|depth, _| 100 * (depth + 1),
    };
    broken(layout, &ruler)
}

/// Part of a line beyond which a left side is too wide for the signs of other relations to stand below its own.
const WIDE_LEFT: usize = 4;

/// Relations below one another in lines of so many points, their signs aligned; one with a wide left side begins where
/// the right sides of the others do.
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

/// Where a segment stands.
struct Segment {
    relation: bool,
    aligned: bool,
    room: usize,
}

/// Cuts one segment greedily; of the breaks that fit, the cheapest is taken.
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
                // A product is torn where nothing else is left.
                let torn = match strength {
                    Strength::Factor => ruler.limit / 2,
                    Strength::Relation | Strength::Term => 0,
                };
                // Later is better on the line, earlier beyond its end.
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

/// The pieces before the bracket that closes one opened just before them, and those after it;
/// `None` if it is closed on another line.
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
