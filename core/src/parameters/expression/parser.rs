//! Compiles the text of an expression into steps of the stack machine.
//!
//! ```text
//! whole  = sum [ "if" sum COMPARE sum "else" sum ]
//! sum    = term { ("+" | "-") term }
//! term   = factor { ("*" | "/" | "%") factor }
//! factor = signed { "^" signed }                      from the left
//! signed = { "+" | "-" } base
//! base   = NUMBER | VARIABLE | CONSTANT [ "()" ] | ONE signed | TWO "(" sum "," sum ")" | "(" whole ")"
//! ```

use super::functions::{CONSTANTS, FUNCTIONS, Function};
use super::{ExpressionError, ExpressionVariable, Op, Operator, STACK};
use crate::diagnostics::did_you_mean;

/// Parentheses and signs may be nested this deep.
const DEPTH: usize = 100;

const VARIABLES: [(&str, ExpressionVariable); 7] = [
    ("x", ExpressionVariable::Current(0)),
    ("y", ExpressionVariable::Current(1)),
    ("z", ExpressionVariable::Current(2)),
    ("X", ExpressionVariable::Initial(0)),
    ("Y", ExpressionVariable::Initial(1)),
    ("Z", ExpressionVariable::Initial(2)),
    ("t", ExpressionVariable::Time),
];

pub(super) fn compile(text: &str) -> Result<Vec<Op>, ExpressionError> {
    let mut parser = Parser { text, next: 0, token: Token::End, start: 0, depth: 0, height: 0, code: Vec::new() };
    parser.advance()?;
    parser.whole()?;
    if parser.token == Token::End { Ok(parser.code) } else { Err(parser.unexpected("an operator or the end")) }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Operator(Operator),
    Comma,
    Open,
    Close,
    End,
}

struct Parser<'a> {
    text: &'a str,
    /// First byte after the token.
    next: usize,
    token: Token<'a>,
    /// First byte of the token.
    start: usize,
    depth: usize,
    /// Values on the stack at this point of the code.
    height: usize,
    code: Vec<Op>,
}

type Parsed<T = ()> = Result<T, ExpressionError>;

impl<'a> Parser<'a> {
    fn error(&self, at: usize, fact: impl Into<String>, remedy: Option<String>) -> ExpressionError {
        let column = self.text[..at].chars().count() as u32 + 1;
        ExpressionError { column, fact: fact.into(), remedy }
    }

    fn advance(&mut self) -> Parsed {
        let rest = &self.text[self.next..];
        self.start = self.next + (rest.len() - rest.trim_start().len());
        let rest = &self.text[self.start..];
        let Some(first) = rest.chars().next() else {
            (self.token, self.next) = (Token::End, self.text.len());
            return Ok(());
        };
        let (token, length) = match first {
            '0'..='9' | '.' => self.number(rest)?,
            'a'..='z' | 'A'..='Z' => {
                let length = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
                (Token::Name(&rest[..length]), length)
            }
            '+' => (Token::Operator(Operator::Add), 1),
            '-' => (Token::Operator(Operator::Subtract), 1),
            '*' if rest.starts_with("**") => (Token::Operator(Operator::Power), 2),
            '*' => (Token::Operator(Operator::Multiply), 1),
            '/' => (Token::Operator(Operator::Divide), 1),
            '%' => (Token::Operator(Operator::Remainder), 1),
            '^' => (Token::Operator(Operator::Power), 1),
            '<' if rest.starts_with("<=") => (Token::Operator(Operator::LessEqual), 2),
            '<' => (Token::Operator(Operator::Less), 1),
            '>' if rest.starts_with(">=") => (Token::Operator(Operator::GreaterEqual), 2),
            '>' => (Token::Operator(Operator::Greater), 1),
            '=' if rest.starts_with("==") => (Token::Operator(Operator::Equal), 2),
            ',' => (Token::Comma, 1),
            '(' => (Token::Open, 1),
            ')' => (Token::Close, 1),
            _ => return Err(self.error(self.start, format!("the character {first:?} has no meaning here"), None)),
        };
        self.token = token;
        self.next = self.start + length;
        Ok(())
    }

    /// Digits with an optional point and exponent; an `e` without digits after it is not part of the number.
    fn number(&self, rest: &'a str) -> Parsed<(Token<'a>, usize)> {
        let bytes = rest.as_bytes();
        let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let mut length = digits(0);
        let mut significant = length;
        if bytes.get(length) == Some(&b'.') {
            let decimals = digits(length + 1);
            significant += decimals;
            length += 1 + decimals;
        }
        if matches!(bytes.get(length), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
            let exponent = bytes.get(length + 1 + sign..).map_or(0, |_| digits(length + 1 + sign));
            if exponent > 0 {
                length += 1 + sign + exponent;
            }
        }
        match rest[..length].parse() {
            Ok(x) if significant > 0 => Ok((Token::Number(x), length)),
            _ => Err(self.error(self.start, "a number needs at least one digit", None)),
        }
    }

    fn unexpected(&self, expected: &str) -> ExpressionError {
        let found = match self.token {
            Token::End => "the end".to_owned(),
            _ => format!("\"{}\"", &self.text[self.start..self.next]),
        };
        let remedy = match self.token {
            Token::Name("and" | "or" | "not") => Some("a condition is one comparison".to_owned()),
            Token::Comma => Some("a comma stands between two arguments of a function: write 1.5 for 1,5".to_owned()),
            Token::Operator(o) if is_comparison(o) => Some("compare only in: A if LEFT < RIGHT else B".to_owned()),
            _ => None,
        };
        self.error(self.start, format!("expected {expected}, found {found}"), remedy)
    }

    fn expect(&mut self, token: Token<'_>, expected: &str) -> Parsed {
        if self.token != token {
            return Err(self.unexpected(expected));
        }
        self.advance()
    }

    /// Adds a step that changes the number of values on the stack by `change`.
    fn emit(&mut self, op: Op, change: isize) -> Parsed {
        self.code.push(op);
        self.height = self.height.saturating_add_signed(change);
        if self.height > STACK {
            let remedy = Some("split the expression".to_owned());
            return Err(self.error(self.start, format!("more than {STACK} values are pending here"), remedy));
        }
        Ok(())
    }

    /// A sum, or one of two by a comparison.
    fn whole(&mut self) -> Parsed {
        let begin = self.code.len();
        self.sum()?;
        if self.token == Token::Name("if") {
            self.advance()?;
            let chosen = self.code.split_off(begin);
            self.height -= 1;
            self.sum()?;
            let Token::Operator(comparison) = self.token else { return Err(self.unexpected("<, <=, >, >= or ==")) };
            if !is_comparison(comparison) {
                return Err(self.unexpected("<, <=, >, >= or =="));
            }
            self.advance()?;
            self.sum()?;
            self.emit(Op::Binary(comparison), -1)?;
            self.expect(Token::Name("else"), "else")?;
            self.emit(Op::SkipUnless(chosen.len() + 1), -1)?;
            self.code.extend(chosen);
            let at = self.code.len();
            self.sum()?;
            let otherwise = self.code.len() - at;
            self.code.insert(at, Op::Skip(otherwise));
        }
        Ok(())
    }

    fn sum(&mut self) -> Parsed {
        self.chain(&[Operator::Add, Operator::Subtract], Self::term)
    }

    fn term(&mut self) -> Parsed {
        self.chain(&[Operator::Multiply, Operator::Divide, Operator::Remainder], Self::factor)
    }

    fn factor(&mut self) -> Parsed {
        self.chain(&[Operator::Power], Self::signed)
    }

    /// Operands joined by operators of one rank, grouped from the left.
    fn chain(&mut self, operators: &[Operator], operand: fn(&mut Self) -> Parsed) -> Parsed {
        operand(self)?;
        while let Token::Operator(operator) = self.token {
            if !operators.contains(&operator) {
                break;
            }
            self.advance()?;
            operand(self)?;
            self.emit(Op::Binary(operator), -1)?;
        }
        Ok(())
    }

    fn signed(&mut self) -> Parsed {
        let mut negative = false;
        while let Token::Operator(sign @ (Operator::Add | Operator::Subtract)) = self.token {
            negative ^= sign == Operator::Subtract;
            self.advance()?;
        }
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.error(self.start, format!("nested more than {DEPTH} deep"), None));
        }
        self.base()?;
        self.depth -= 1;
        if negative { self.emit(Op::Negate, 0) } else { Ok(()) }
    }

    fn base(&mut self) -> Parsed {
        match self.token {
            Token::Number(x) => {
                self.advance()?;
                self.emit(Op::Push(x), 1)
            }
            Token::Open => {
                self.advance()?;
                self.whole()?;
                self.expect(Token::Close, "\")\"")
            }
            Token::Name(name) => self.name(name),
            _ => Err(self.unexpected("a value")),
        }
    }

    fn name(&mut self, name: &str) -> Parsed {
        if let Some((_, variable)) = VARIABLES.iter().find(|v| v.0 == name) {
            self.advance()?;
            return self.emit(Op::Load(*variable), 1);
        }
        if let Some((_, constant)) = CONSTANTS.iter().find(|c| c.0 == name) {
            self.advance()?;
            if self.token == Token::Open {
                self.advance()?;
                self.expect(Token::Close, "\")\"")?;
            }
            return self.emit(Op::Push(*constant), 1);
        }
        match FUNCTIONS.iter().find(|f| f.0 == name) {
            Some((_, Function::One(f))) => {
                self.advance()?;
                self.signed()?;
                self.emit(Op::One(*f), 0)
            }
            Some((_, Function::Two(f))) => {
                self.advance()?;
                self.expect(Token::Open, "\"(\"")?;
                self.sum()?;
                self.expect(Token::Comma, "\",\" and the second argument")?;
                self.sum()?;
                self.expect(Token::Close, "\")\"")?;
                self.emit(Op::Two(*f), -1)
            }
            None if matches!(name, "if" | "else" | "and" | "or" | "not") => Err(self.unexpected("a value")),
            None => Err(self.unknown(name)),
        }
    }

    fn unknown(&self, name: &str) -> ExpressionError {
        let variables = VARIABLES.iter().map(|v| v.0);
        let constants = CONSTANTS.iter().map(|c| c.0);
        let known: Vec<&str> = variables.chain(constants).chain(FUNCTIONS.iter().map(|f| f.0)).collect();
        let list = format!("known names: {}", known.join(" "));
        let remedy = match did_you_mean(name, known.iter().copied()) {
            Some(near) => format!("{near} {list}"),
            None => list,
        };
        self.error(self.start, format!("unknown name \"{name}\""), Some(remedy))
    }
}

fn is_comparison(operator: Operator) -> bool {
    use Operator::{Equal, Greater, GreaterEqual, Less, LessEqual};
    matches!(operator, Less | LessEqual | Greater | GreaterEqual | Equal)
}
