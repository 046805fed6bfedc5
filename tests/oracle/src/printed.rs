//! Parses and evaluates printed formulas: plain text from cards, documents and rustdoc, with Unicode subscripts and superscripts.
//! Takes a formula and the values of its symbols by their printed names, and returns matrices. It reads like a human reader:
//! products from left to right, and a superscript applies to the preceding factor.

/// A matrix of numbers, row by row; a scalar is 1 x 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// Entries, row by row.
    pub data: Vec<f64>,
}

impl Value {
    /// A matrix from its entries.
    pub fn new(rows: usize, cols: usize, data: &[f64]) -> Value {
        assert_eq!(rows * cols, data.len());
        Value {
            rows,
            cols,
            data: data.to_vec(),
        }
    }

    /// A scalar.
    pub fn number(x: f64) -> Value {
        Value::new(1, 1, &[x])
    }

    fn of(rows: usize, cols: usize, f: impl Fn(usize, usize) -> f64) -> Value {
        let data: Vec<f64> = (0..rows * cols).map(|k| f(k / cols, k % cols)).collect();
        Value::new(rows, cols, &data)
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.data[i * self.cols + j]
    }

    fn is_number(&self) -> bool {
        self.data.len() == 1
    }

    fn scaled(&self, x: f64) -> Value {
        Value::of(self.rows, self.cols, |i, j| x * self.at(i, j))
    }

    fn times(&self, b: &Value) -> Value {
        if self.is_number() {
            return b.scaled(self.data[0]);
        }
        if b.is_number() {
            return self.scaled(b.data[0]);
        }
        assert_eq!(self.cols, b.rows, "a product of {self:?} and {b:?}");
        let entry = |i, j| (0..self.cols).map(|k| self.at(i, k) * b.at(k, j)).sum();
        Value::of(self.rows, b.cols, entry)
    }

    /// A sum of two values of equal shape.
    fn plus(&self, b: &Value, sign: f64) -> Value {
        assert_eq!(
            (self.rows, self.cols),
            (b.rows, b.cols),
            "a sum of {self:?} and {b:?}"
        );
        Value::of(self.rows, self.cols, |i, j| {
            self.at(i, j) + sign * b.at(i, j)
        })
    }

    fn entries(&self, rows: std::ops::Range<usize>, cols: std::ops::Range<usize>) -> Value {
        Value::of(rows.len(), cols.len(), |i, j| {
            self.at(rows.start + i, cols.start + j)
        })
    }

    /// A block matrix from `parts`, with block heights `rows` and widths `cols`. A block 0 denotes a zero block of any size.
    fn blocks(parts: &[Vec<Value>], rows: &[usize], cols: &[usize]) -> Value {
        let (height, width) = (rows.iter().sum(), cols.iter().sum());
        let place = |sizes: &[usize], mut at: usize| {
            let block = sizes.iter().position(|n| match at.checked_sub(*n) {
                Some(rest) => {
                    at = rest;
                    false
                }
                None => true,
            });
            (block.expect("a block"), at)
        };
        Value::of(height, width, |i, j| {
            let ((r, i), (c, j)) = (place(rows, i), place(cols, j));
            match &parts[r][c] {
                zero if zero.data == [0.0] => 0.0,
                block => {
                    assert_eq!((block.rows, block.cols), (rows[r], cols[c]));
                    block.at(i, j)
                }
            }
        })
    }

    fn transposed(&self) -> Value {
        Value::of(self.cols, self.rows, |i, j| self.at(j, i))
    }

    /// Inverse and determinant, by elimination with partial pivoting.
    pub fn inverted(&self) -> (Value, f64) {
        let n = self.rows;
        let mut rows: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                (0..2 * n)
                    .map(|j| {
                        if j < n {
                            self.at(i, j)
                        } else {
                            f64::from(u8::from(j == n + i))
                        }
                    })
                    .collect()
            })
            .collect();
        let mut det = 1.0;
        for c in 0..n {
            let p = (c..n)
                .max_by(|a, b| rows[*a][c].abs().total_cmp(&rows[*b][c].abs()))
                .unwrap_or(c);
            if p != c {
                rows.swap(c, p);
                det = -det;
            }
            let d = rows[c][c];
            det *= d;
            rows[c].iter_mut().for_each(|x| *x /= d);
            let pivot = rows[c].clone();
            for (r, row) in rows.iter_mut().enumerate().filter(|(r, _)| *r != c) {
                let f = row[c];
                debug_assert_ne!(r, c);
                row.iter_mut().zip(&pivot).for_each(|(x, y)| *x -= f * y);
            }
        }
        (Value::of(n, n, |i, j| rows[i][n + j]), det)
    }
}

fn hat(v: &[f64]) -> Value {
    Value::new(
        3,
        3,
        &[0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0],
    )
}

/// The left-multiplication matrix of a quaternion.
pub fn quaternion([w, x, y, z]: [f64; 4]) -> Value {
    Value::new(
        4,
        4,
        &[w, -x, -y, -z, x, w, -z, y, y, z, w, -x, z, -y, x, w],
    )
}

fn components(q: &Value) -> [f64; 4] {
    [0, 1, 2, 3].map(|k| {
        let unit = quaternion([0, 1, 2, 3].map(|i| f64::from(u8::from(i == k))));
        q.data
            .iter()
            .zip(&unit.data)
            .map(|(a, b)| a * b)
            .sum::<f64>()
            / 4.0
    })
}

fn rotation(e: &Value) -> Value {
    if e.data[12..] == [0.0, 0.0, 0.0, 1.0] {
        return Value::of(3, 3, |i, j| e.at(i, j));
    }
    let [w, v @ ..] = components(e);
    let square: f64 = v.iter().map(|x| x * x).sum();
    let turn = hat(&v);
    let diagonal = |i: usize, j: usize| if i == j { w * w - square } else { 0.0 };
    Value::of(3, 3, |i, j| {
        diagonal(i, j) + 2.0 * v[i] * v[j] + 2.0 * w * turn.at(i, j)
    })
}

/// The value of a function at an argument.
fn applied(function: &str, a: &Value) -> Value {
    let part = |sign: f64| {
        Value::of(a.rows, a.cols, |i, j| {
            (a.at(i, j) + sign * a.at(j, i)) / 2.0
        })
    };
    match function {
        "tr" => Value::number((0..a.rows).map(|i| a.at(i, i)).sum()),
        "det" => Value::number(a.inverted().1),
        "adj" => {
            let (inverse, det) = a.inverted();
            inverse.scaled(det)
        }
        "vee" => {
            let half = |i, j| (a.at(i, j) - a.at(j, i)) / 2.0;
            Value::new(3, 1, &[half(2, 1), half(0, 2), half(1, 0)])
        }
        "hat" => hat(&a.data),
        "sym" => part(1.0),
        "skew" => part(-1.0),
        "diag" if a.cols == 1 => {
            Value::of(a.rows, a.rows, |i, j| if i == j { a.at(i, 0) } else { 0.0 })
        }
        "diag" => Value::of(a.rows, a.cols, |i, j| if i == j { a.at(i, j) } else { 0.0 }),
        "exp" => Value::number(a.data[0].exp()),
        "log" => Value::number(a.data[0].ln()),
        "sin" => Value::number(a.data[0].sin()),
        "cos" => Value::number(a.data[0].cos()),
        "sinh" => Value::number(a.data[0].sinh()),
        "cosh" => Value::number(a.data[0].cosh()),
        "tanh" => Value::number(a.data[0].tanh()),
        "abs" => Value::number(a.data[0].abs()),
        "sign" => Value::number(a.data[0].signum()),
        "ang" => a.entries(0..3, 0..1),
        "lin" => a.entries(3..6, 0..1),
        "re" => Value::number(components(a)[0]),
        "im" => Value::new(3, 1, &components(a)[1..]),
        "quat" => quaternion([0.0, a.data[0], a.data[1], a.data[2]]),
        "rot" => rotation(a),
        "pos" => Value::new(3, 1, &[a.at(0, 3), a.at(1, 3), a.at(2, 3)]),
        "twist" => {
            let turn = hat(&a.data[..3]);
            Value::of(4, 4, |i, j| match (i, j) {
                (3, _) => 0.0,
                (i, 3) => a.data[i + 3],
                (i, j) => turn.at(i, j),
            })
        }
        other => panic!("no function {other}"),
    }
}

const FUNCTIONS: [&str; 27] = [
    "ang", "lin", "sign", "tr", "det", "adj", "vee", "hat", "sym", "skew", "diag", "exp", "log",
    "sinh", "cosh", "tanh", "sin", "cos", "abs", "re", "im", "quat", "rot", "pos", "twist", "sqrt",
    "Id",
];

/// Superscripts, subscripts and fractions of one character.
const DIGITS: [&str; 2] = ["⁰¹²³⁴⁵⁶⁷⁸⁹", "₀₁₂₃₄₅₆₇₈₉"];
const FRACTIONS: [(char, f64, f64); 15] = [
    ('½', 1.0, 2.0),
    ('⅓', 1.0, 3.0),
    ('⅔', 2.0, 3.0),
    ('¼', 1.0, 4.0),
    ('¾', 3.0, 4.0),
    ('⅕', 1.0, 5.0),
    ('⅖', 2.0, 5.0),
    ('⅗', 3.0, 5.0),
    ('⅘', 4.0, 5.0),
    ('⅙', 1.0, 6.0),
    ('⅚', 5.0, 6.0),
    ('⅛', 1.0, 8.0),
    ('⅜', 3.0, 8.0),
    ('⅝', 5.0, 8.0),
    ('⅞', 7.0, 8.0),
];

/// Values of symbols by their printed names.
pub type Letters<'a> = [(String, Value)];

/// The value of a printed formula; a bare `Id` next to matrices has their number of rows.
pub fn value(text: &str, letters: &Letters) -> Value {
    let mut reader = Reader {
        rest: text.trim(),
        letters,
    };
    let out = reader.sum();
    assert!(
        reader.rest.is_empty(),
        "left over: {:?} of {text}",
        reader.rest
    );
    out.fixed()
}

/// A value, or a multiple of the identity whose size follows from the neighbouring term.
#[derive(Clone, Debug)]
enum Part {
    Known(Value),
    Identity(f64),
}

impl Part {
    fn fixed(self) -> Value {
        match self {
            Part::Known(v) => v,
            Part::Identity(_) => panic!("an identity of no size"),
        }
    }

    fn plus(self, b: Part, sign: f64) -> Part {
        let identity = |n: usize, x: f64| Value::of(n, n, |i, j| if i == j { x } else { 0.0 });
        match (self, b) {
            (Part::Known(a), Part::Known(b)) => Part::Known(a.plus(&b, sign)),
            (Part::Known(a), Part::Identity(x)) => Part::Known(a.plus(&identity(a.rows, x), sign)),
            (Part::Identity(x), Part::Known(b)) => Part::Known(identity(b.rows, x).plus(&b, sign)),
            (Part::Identity(x), Part::Identity(y)) => Part::Identity(x + sign * y),
        }
    }

    fn times(self, b: Part) -> Part {
        match (self, b) {
            (Part::Known(a), Part::Known(b)) => Part::Known(a.times(&b)),
            (Part::Known(a), Part::Identity(x)) | (Part::Identity(x), Part::Known(a)) => {
                match a.is_number() {
                    true => Part::Identity(x * a.data[0]),
                    false => Part::Known(a.scaled(x)),
                }
            }
            (Part::Identity(x), Part::Identity(y)) => Part::Identity(x * y),
        }
    }

    fn scaled(self, x: f64) -> Part {
        Part::Known(Value::number(x)).times(self)
    }
}

struct Reader<'a> {
    rest: &'a str,
    letters: &'a Letters<'a>,
}

impl Reader<'_> {
    fn eat(&mut self, token: &str) -> bool {
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn sum(&mut self) -> Part {
        let minus = self.eat("-");
        let first = self.term();
        let mut total = if minus { first.scaled(-1.0) } else { first };
        loop {
            let sign = if self.eat(" + ") {
                1.0
            } else if self.eat(" - ") {
                -1.0
            } else {
                return total;
            };
            let next = self.term();
            total = total.plus(next, sign);
        }
    }

    /// Products of every kind, from left to right.
    fn term(&mut self) -> Part {
        let mut total = self.factor();
        loop {
            if self.eat("·") {
                let (a, b) = (total.fixed(), self.factor().fixed());
                total = Part::Known(a.transposed().times(&b));
            } else if self.eat(" × ") {
                let (a, b) = (total.fixed(), self.factor().fixed());
                total = Part::Known(hat(&a.data).times(&b));
            } else if self.eat("/") {
                let below = self.factor().fixed();
                total = total.scaled(1.0 / below.data[0]);
            } else if self.rest.starts_with(" + ") || self.rest.starts_with(" - ") || !self.eat(" ")
            {
                return total;
            } else {
                let next = self.factor();
                total = total.times(next);
            }
        }
    }

    fn factor(&mut self) -> Part {
        let mut out = self.atom();
        loop {
            if self.eat("ᵀ") {
                out = Part::Known(out.fixed().transposed());
            } else if self.eat("[1:3, 1:3]") {
                out = Part::Known(out.fixed().entries(0..3, 0..3));
            } else if self.eat("[1:3, 4]") {
                out = Part::Known(out.fixed().entries(0..3, 3..4));
            } else if self.eat("[1:3]") {
                out = Part::Known(out.fixed().entries(0..3, 0..1));
            } else if self.eat("⁻ᵀ") {
                out = Part::Known(out.fixed().inverted().0.transposed());
            } else if let Some(power) = self.superscript() {
                out = Part::Known(raised(out.fixed(), power));
            } else {
                return out;
            }
        }
    }

    /// An exponent: `²`, `⁻¹`, `^{3/2}`.
    fn superscript(&mut self) -> Option<f64> {
        if self.eat("^{") {
            let (inside, rest) = self.rest.split_once('}')?;
            self.rest = rest;
            let mut parts = inside
                .split('/')
                .map(|p| p.parse::<f64>().expect("an exponent"));
            let top = parts.next()?;
            return Some(top / parts.next().unwrap_or(1.0));
        }
        let minus = self.eat("⁻");
        let mut number: Option<f64> = None;
        while let Some((i, c)) = self
            .rest
            .chars()
            .next()
            .and_then(|c| Some((DIGITS[0].chars().position(|d| d == c)?, c)))
        {
            number = Some(10.0 * number.unwrap_or(0.0) + i as f64);
            self.rest = &self.rest[c.len_utf8()..];
        }
        number.map(|n| if minus { -n } else { n })
    }

    fn atom(&mut self) -> Part {
        if self.eat("√") {
            let inside = self.atom().fixed();
            return Part::Known(Value::number(inside.data[0].sqrt()));
        }
        if self.eat("|") {
            // In factor position, a bar opens: the length of a vector, or the absolute value of a number.
            let inside = self.sum().fixed();
            assert!(self.eat("|"), "no bar closes before {:?}", self.rest);
            let square: f64 = inside.data.iter().map(|x| x * x).sum();
            return Part::Known(Value::number(square.sqrt()));
        }
        if self.eat("(") {
            let inside = self.sum();
            if self.eat(", ") {
                // The angular and the linear part of a vector with six components.
                let parts = [vec![inside.fixed()], vec![self.sum().fixed()]];
                assert!(self.eat(")"), "no bracket closes before {:?}", self.rest);
                return Part::Known(Value::blocks(&parts, &[3, 3], &[1]));
            }
            assert!(self.eat(")"), "no bracket closes before {:?}", self.rest);
            return inside;
        }
        if self.eat("[") {
            // Homogeneous coordinates, `[v; 0]` or `[A, v; 0, 0]`.
            let mut rows = vec![Vec::new()];
            loop {
                let entry = self.sum().fixed();
                rows.last_mut().expect("a row").push(entry);
                if self.eat("; ") {
                    rows.push(Vec::new());
                } else if !self.eat(", ") {
                    break;
                }
            }
            assert!(self.eat("]"), "no bracket closes before {:?}", self.rest);
            let cols: &[usize] = if rows[0].len() == 1 { &[1] } else { &[3, 1] };
            return Part::Known(Value::blocks(&rows, &[3, 1], cols));
        }
        let first = self.rest.chars().next().expect("a factor");
        if let Some((_, top, bottom)) = FRACTIONS.iter().find(|(c, ..)| *c == first) {
            self.rest = &self.rest[first.len_utf8()..];
            return Part::Known(Value::number(top / bottom));
        }
        if first.is_ascii_digit() {
            let end = self
                .rest
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(self.rest.len());
            let number = self.rest[..end].parse().expect("digits");
            self.rest = &self.rest[end..];
            return Part::Known(Value::number(number));
        }
        // The longest matching name: `J₁` before `J`.
        let fits = self
            .letters
            .iter()
            .filter(|(name, _)| self.rest.starts_with(name.as_str()));
        let letter = fits.max_by_key(|(name, _)| name.len());
        let called = |f: &&&str| self.rest[f.len()..].starts_with('(');
        let function = FUNCTIONS
            .iter()
            .filter(|f| self.rest.starts_with(**f))
            .find(called);
        if let Some(f) = function {
            self.rest = &self.rest[f.len()..];
            let inside = self.atom();
            return Part::Known(applied(f, &inside.fixed()));
        }
        if let Some((name, value)) = letter {
            self.rest = &self.rest[name.len()..];
            return Part::Known(value.clone());
        }
        let small = |c: char| DIGITS[1].chars().position(|d| d == c);
        let mut numbers = Vec::new();
        let name = ["Id", "ι", "E"]
            .into_iter()
            .find(|n| self.rest.starts_with(*n));
        let name = name.unwrap_or_else(|| panic!("what is {:?}?", self.rest));
        self.rest = &self.rest[name.len()..];
        while let Some((c, n)) = self.rest.chars().next().and_then(|c| Some((c, small(c)?))) {
            numbers.push(n);
            self.rest = &self.rest[c.len_utf8()..];
        }
        match (name, numbers.as_slice()) {
            ("Id", []) => Part::Identity(1.0),
            ("Id", [n]) => Part::Known(Value::of(*n, *n, |i, j| f64::from(u8::from(i == j)))),
            // Embeds three components into `n`, starting at index `from`.
            ("ι", [n, from]) => Part::Known(Value::of(*n, 3, |i, j| {
                f64::from(u8::from(i + 1 == from + j))
            })),
            ("E", [axis]) => Part::Known(Value::of((*axis).max(3), 1, |i, _| {
                f64::from(u8::from(i + 1 == *axis))
            })),
            other => panic!("{other:?}"),
        }
    }
}

fn raised(base: Value, power: f64) -> Value {
    if base.is_number() {
        return Value::number(base.data[0].powf(power));
    }
    let root = if power < 0.0 { base.inverted().0 } else { base };
    let mut out = root.clone();
    for _ in 1..power.abs() as usize {
        out = out.times(&root);
    }
    out
}
