//! Tokens of a shader's text after the preprocessor [GLSL 4.60, 3.1 to 3.3]: conditions, macros with and without parameters.

use std::collections::HashMap;

/// One token, a part of the text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Token<'a> {
    Word(&'a str),
    /// A literal, and whether it is a float.
    Number(f64, bool),
    Sign(&'a str),
}

/// A macro: its parameters, if it has a list of them, and its text.
struct Macro<'a> {
    parameters: Option<Vec<&'a str>>,
    body: Vec<Token<'a>>,
}

/// Names that stand for something.
type Macros<'a> = HashMap<&'a str, Macro<'a>>;

const PAIRS: [&str; 14] = ["++", "--", "+=", "-=", "*=", "/=", "<=", ">=", "==", "!=", "&&", "||", "^^", "<<"];

/// All tokens of a text, macros expanded. `Err`: what is not understood.
pub fn tokens(text: &str) -> Result<Vec<Token<'_>>, String> {
    let mut macros = Macros::new();
    let mut found = Vec::new();
    let mut pending = Vec::new();
    // For each open condition: this branch is read, one of its branches was.
    let mut open: Vec<[bool; 2]> = Vec::new();
    for line in text.lines() {
        let line = line.split("//").next().unwrap_or("");
        let is_read = open.iter().all(|[is_read, _]| *is_read);
        let Some(directive) = line.trim_start().strip_prefix('#') else {
            if is_read {
                split(line, &mut pending)?;
            }
            continue;
        };
        let (name, rest) = word_at(directive.trim_start());
        if is_read && ["define", "undef"].contains(&name) {
            found.append(&mut expand(&pending, &macros, &[])?);
            pending.clear();
        }
        match name {
            "version" | "extension" | "line" => {}
            "define" if is_read => define(rest, &mut macros)?,
            "undef" if is_read => {
                macros.remove(rest.trim());
            }
            "define" | "undef" => {}
            "ifdef" | "ifndef" | "if" => {
                let holds = is_read && condition(name, rest, &macros)?;
                open.push([holds, holds || !is_read]);
            }
            "elif" | "else" => {
                let [_, was_read] = open.pop().ok_or("#else without #if")?;
                let holds = !was_read && (name == "else" || condition("if", rest, &macros)?);
                open.push([holds, was_read || holds]);
            }
            "endif" => {
                open.pop();
            }
            _ => return Err(format!("directive #{name}")),
        }
    }
    found.append(&mut expand(&pending, &macros, &[])?);
    Ok(found)
}

/// The word that a text begins with, and what follows it.
fn word_at(text: &str) -> (&str, &str) {
    let is_in = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split_at(text.find(|c| !is_in(c)).unwrap_or(text.len()))
}

/// Adds the tokens of a line.
fn split<'a>(line: &'a str, to: &mut Vec<Token<'a>>) -> Result<(), String> {
    let mut rest = line.trim_start();
    while let Some(first) = rest.chars().next() {
        let digits = rest.trim_start_matches('.');
        let (token, length) = match first {
            _ if first.is_ascii_digit() || (first == '.' && digits.starts_with(|c: char| c.is_ascii_digit())) => {
                number(rest)?
            }
            _ if first.is_ascii_alphabetic() || first == '_' => {
                let (word, _) = word_at(rest);
                (Token::Word(word), word.len())
            }
            _ => {
                let pair = PAIRS.iter().find(|pair| rest.starts_with(**pair));
                let length = pair.map_or(first.len_utf8(), |pair| pair.len());
                (Token::Sign(&rest[..length]), length)
            }
        };
        to.push(token);
        rest = rest[length..].trim_start();
    }
    Ok(())
}

fn number(text: &str) -> Result<(Token<'_>, usize), String> {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let is_sign = matches!(bytes[end], b'+' | b'-') && matches!(bytes[end - 1], b'e' | b'E');
        if !(bytes[end].is_ascii_alphanumeric() || bytes[end] == b'.' || is_sign) {
            break;
        }
        end += 1;
    }
    let digits = text[..end].trim_end_matches(['u', 'U', 'f', 'F']);
    let value = digits.parse().map_err(|_| format!("number {}", &text[..end]))?;
    Ok((Token::Number(value, digits.contains(['.', 'e', 'E'])), end))
}

fn define<'a>(rest: &'a str, macros: &mut Macros<'a>) -> Result<(), String> {
    let (name, mut rest) = word_at(rest.trim_start());
    let mut parameters = None;
    if let Some(list) = rest.strip_prefix('(') {
        let (list, after) = list.split_once(')').ok_or("a macro without )")?;
        parameters = Some(list.split(',').map(str::trim).filter(|name| !name.is_empty()).collect());
        rest = after;
    }
    let mut body = Vec::new();
    split(rest, &mut body)?;
    macros.insert(name, Macro { parameters, body });
    Ok(())
}

fn condition(directive: &str, rest: &str, macros: &Macros) -> Result<bool, String> {
    let is_defined = |name: &str| macros.contains_key(name);
    match directive {
        "ifdef" => Ok(is_defined(rest.trim())),
        "ifndef" => Ok(!is_defined(rest.trim())),
        _ => {
            let mut list = Vec::new();
            split(rest, &mut list)?;
            let mut at = 0;
            any(&list, &mut at, &is_defined).ok_or_else(|| format!("#if {rest}"))
        }
    }
}

/// `||` of `&&` of `!` of defined(NAME) and parentheses.
fn any(list: &[Token], at: &mut usize, is_defined: &dyn Fn(&str) -> bool) -> Option<bool> {
    let mut result = all(list, at, is_defined)?;
    while list.get(*at) == Some(&Token::Sign("||")) {
        *at += 1;
        result |= all(list, at, is_defined)?;
    }
    Some(result)
}

fn all(list: &[Token], at: &mut usize, is_defined: &dyn Fn(&str) -> bool) -> Option<bool> {
    let mut result = one(list, at, is_defined)?;
    while list.get(*at) == Some(&Token::Sign("&&")) {
        *at += 1;
        result &= one(list, at, is_defined)?;
    }
    Some(result)
}

fn one(list: &[Token], at: &mut usize, is_defined: &dyn Fn(&str) -> bool) -> Option<bool> {
    let token = *list.get(*at)?;
    *at += 1;
    match token {
        Token::Sign("!") => Some(!one(list, at, is_defined)?),
        Token::Sign("(") => {
            let result = any(list, at, is_defined)?;
            *at += 1;
            Some(result)
        }
        Token::Word("defined") => {
            let is_open = list.get(*at) == Some(&Token::Sign("("));
            *at += usize::from(is_open);
            let Token::Word(name) = *list.get(*at)? else { return None };
            *at += 1 + usize::from(is_open);
            Some(is_defined(name))
        }
        _ => None,
    }
}

/// Macros replaced; those of `hidden` are being replaced already.
fn expand<'a>(list: &[Token<'a>], macros: &Macros<'a>, hidden: &[&str]) -> Result<Vec<Token<'a>>, String> {
    let mut out = Vec::with_capacity(list.len());
    let mut at = 0;
    while at < list.len() {
        let token = list[at];
        at += 1;
        let found = match token {
            Token::Word(name) if !hidden.contains(&name) => macros.get(name).map(|known| (name, known)),
            _ => None,
        };
        let Some((name, known)) = found else {
            out.push(token);
            continue;
        };
        let inside = [hidden, &[name]].concat();
        let Some(parameters) = &known.parameters else {
            out.extend(expand(&known.body, macros, &inside)?);
            continue;
        };
        if list.get(at) != Some(&Token::Sign("(")) {
            out.push(token);
            continue;
        }
        let arguments = arguments(list, &mut at).ok_or_else(|| format!("call of {name} without )"))?;
        let mut body = Vec::new();
        for token in &known.body {
            let place = parameters.iter().position(|parameter| *token == Token::Word(parameter));
            match place.and_then(|place| arguments.get(place)) {
                Some(argument) => body.extend(expand(argument, macros, hidden)?),
                None => body.push(*token),
            }
        }
        out.extend(expand(&body, macros, &inside)?);
    }
    Ok(out)
}

/// Arguments of a call whose `(` stands at `at`, which is left behind its `)`.
fn arguments<'a>(list: &[Token<'a>], at: &mut usize) -> Option<Vec<Vec<Token<'a>>>> {
    let mut arguments = vec![Vec::new()];
    let mut depth = 0;
    loop {
        let token = *list.get(*at)?;
        *at += 1;
        match token {
            Token::Sign("(") => {
                depth += 1;
                if depth == 1 {
                    continue;
                }
            }
            Token::Sign(")") => {
                depth -= 1;
                if depth == 0 {
                    return Some(arguments);
                }
            }
            Token::Sign(",") if depth == 1 => {
                arguments.push(Vec::new());
                continue;
            }
            _ => {}
        }
        arguments.last_mut()?.push(token);
    }
}
