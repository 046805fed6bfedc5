//! The grammar of expressions. Takes tokens; gives a tree.

use super::names::{self, Names};
use super::tokens::{Piece, Token};
use super::tree::Tree;
use super::{FUNCTIONS, Mistake};
use std::f64::consts::PI;

/// The deepest nesting.
const DEEPEST: usize = 100;

/// Parses all tokens.
pub(super) fn parse(tokens: &[Token], names: &Names) -> Result<Tree, Mistake> {
    let mut parser = Parser {
        tokens,
        at: 0,
        names,
        depth: 0,
    };
    let tree = parser.sum()?;
    let rest = parser.peek();
    match rest.piece {
        Piece::End => Ok(tree),
        _ => Err(unexpected(rest, "an operation such as + or *")),
    }
}

struct Parser<'a> {
    tokens: &'a [Token],
    at: usize,
    names: &'a Names,
    depth: usize,
}

const END: Token = Token {
    piece: Piece::End,
    at: 0,
    length: 1,
};

fn unexpected(token: &Token, wanted: &str) -> Mistake {
    Mistake {
        at: token.at,
        length: token.length,
        what: format!("unexpected {}", token.described()),
        remedy: format!("Write {wanted} here."),
    }
}

impl<'a> Parser<'a> {
    fn peek(&self) -> &'a Token {
        self.tokens
            .get(self.at)
            .or(self.tokens.last())
            .unwrap_or(&END)
    }

    fn takes(&mut self, sign: char) -> bool {
        let is = self.peek().piece == Piece::Sign(sign);
        self.at += usize::from(is);
        is
    }

    fn needs(&mut self, sign: char) -> Result<(), Mistake> {
        match self.takes(sign) {
            true => Ok(()),
            false => Err(unexpected(self.peek(), &format!("`{sign}`"))),
        }
    }

    fn sum(&mut self) -> Result<Tree, Mistake> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let token = self.peek();
            return Err(Mistake {
                at: token.at,
                length: token.length,
                what: format!("more than {DEEPEST} brackets within each other"),
                remedy: "Remove brackets.".to_owned(),
            });
        }
        let first = self.product()?;
        let mut all = vec![(false, first)];
        loop {
            let minus = match self.peek().piece {
                Piece::Sign('+') => false,
                Piece::Sign('-') => true,
                _ => break,
            };
            self.at += 1;
            all.push((minus, self.product()?));
        }
        self.depth -= 1;
        Ok(only(all).unwrap_or_else(Tree::Sum))
    }

    fn product(&mut self) -> Result<Tree, Mistake> {
        let mut all = vec![(false, self.signed()?)];
        loop {
            let divides = match self.peek().piece {
                Piece::Sign('*') => false,
                Piece::Sign('/') => true,
                _ => break,
            };
            self.at += 1;
            all.push((divides, self.signed()?));
        }
        Ok(only(all).unwrap_or_else(Tree::Product))
    }

    /// A factor after any number of signs.
    fn signed(&mut self) -> Result<Tree, Mistake> {
        let mut minus = false;
        loop {
            match self.peek().piece {
                Piece::Sign('-') => minus = !minus,
                Piece::Sign('+') => {}
                _ => break,
            }
            self.at += 1;
        }
        let tree = self.power()?;
        Ok(match minus {
            true => Tree::Negative(Box::new(tree)),
            false => tree,
        })
    }

    fn power(&mut self) -> Result<Tree, Mistake> {
        let base = self.atom()?;
        if !self.takes('^') {
            return Ok(base);
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(unexpected(self.peek(), "fewer powers"));
        }
        let exponent = self.signed()?;
        self.depth -= 1;
        Ok(Tree::Power(Box::new(base), Box::new(exponent)))
    }

    fn atom(&mut self) -> Result<Tree, Mistake> {
        let token = self.peek();
        self.at += 1;
        match &token.piece {
            Piece::Number(x) => Ok(Tree::Number(*x)),
            Piece::Sign('(') => {
                let inner = self.sum()?;
                self.needs(')')?;
                Ok(inner)
            }
            Piece::Name(name) => {
                let function = FUNCTIONS.iter().position(|(own, ..)| own == name);
                if self.peek().piece == Piece::Sign('(') {
                    return self.call(token, function);
                }
                self.quantity(token, name)
            }
            _ => Err(unexpected(token, "a number, a name or `(`")),
        }
    }

    fn call(&mut self, token: &Token, function: Option<usize>) -> Result<Tree, Mistake> {
        let Some(function) = function else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|(name, ..)| *name).collect();
            return Err(Mistake {
                at: token.at,
                length: token.length,
                what: format!("{} is not a function", token.described()),
                remedy: format!(
                    "Available: {}. Components have square brackets",
                    known.join(", ")
                ),
            });
        };
        self.needs('(')?;
        let inner = self.sum()?;
        self.needs(')')?;
        Ok(Tree::Call(function, Box::new(inner)))
    }

    fn quantity(&mut self, token: &Token, name: &str) -> Result<Tree, Mistake> {
        let mut components = Vec::new();
        let mut name = name.to_owned();
        if let Piece::Part(part) = &self.peek().piece {
            self.at += 1;
            name = names::column(&name, part);
        }
        while self.takes('[') {
            loop {
                let own = self.peek();
                match own.piece {
                    // Components have smaller numbers.
                    Piece::Number(x) if x.fract() == 0.0 && (0.0..1e9).contains(&x) => {
                        components.push(x as usize);
                    }
                    _ => return Err(unexpected(own, "a whole number")),
                }
                self.at += 1;
                if !self.takes(',') {
                    break;
                }
            }
            self.needs(']')?;
        }
        let last = self.tokens.get(self.at - 1).unwrap_or(token);
        match self.names.place(&name, &components) {
            Ok(at) => Ok(Tree::Seen(at)),
            Err(_) if components.is_empty() && matches!(name.as_str(), "pi" | "π") => {
                Ok(Tree::Number(PI))
            }
            Err((what, remedy)) => Err(Mistake {
                at: token.at,
                length: last.at + last.length - token.at,
                what,
                remedy,
            }),
        }
    }
}

/// The only term, if there is one that is not negative.
fn only(mut all: Vec<(bool, Tree)>) -> Result<Tree, Vec<(bool, Tree)>> {
    match (all.len(), all.pop()) {
        (1, Some((false, tree))) => Ok(tree),
        (_, Some(last)) => {
            all.push(last);
            Err(all)
        }
        (_, None) => Err(all),
    }
}
