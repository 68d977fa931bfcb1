//! Programs as trees, and their text in GLSL.

use super::functions::{Function, Style};
use crate::conformance::model::number::Num;
use crate::conformance::model::value::{GlslValue, NumberBase, Type, literal};

/// An expression with its type.
#[derive(Clone)]
pub struct Expr {
    pub kind: Type,
    pub form: Form,
}

#[derive(Clone)]
pub enum Form {
    Literal(GlslValue),
    /// A variable, by its number.
    Variable(usize),
    Call(&'static Function, Vec<Expr>),
    /// A constructor by the type's name.
    Construct(Vec<Expr>),
    /// condition ? first : second.
    Select(Box<[Expr; 3]>),
    Swizzle(Box<Expr>, Vec<usize>),
    /// An element, column or component.
    Index(Box<[Expr; 2]>),
    /// A function of the program: its number, and the arguments.
    Own(usize, Vec<Expr>),
}

/// A variable, or a part of one, that is written.
#[derive(Clone)]
pub struct Place {
    pub variable: usize,
    /// An element, a column or a component of the variable.
    pub index: Option<Expr>,
    /// Components of the rest.
    pub swizzle: Vec<usize>,
    pub kind: Type,
}

#[derive(Clone)]
pub enum Statement {
    Declare(usize, Expr),
    /// The same of a constant expression.
    Constant(usize, Expr),
    /// The operator before `=`, or none.
    Assign(Place, Option<&'static Function>, Expr),
    If(Expr, Vec<Statement>, Vec<Statement>),
    For(Loop),
    /// `while` with a counter of its own.
    While(Loop),
    DoWhile(Loop),
    Switch(Expr, Vec<Case>),
    Block(Vec<Statement>),
    Break,
    Continue,
    Return(Option<Expr>),
    Discard,
    /// A call that writes its arguments; its result goes to a new variable, if it has one.
    Call(Option<usize>, usize, Vec<Argument>),
}

/// Turns of a loop: a counter from `first` while it is below `end`, by `step`.
#[derive(Clone)]
pub struct Loop {
    pub counter: usize,
    pub first: i32,
    pub end: Expr,
    pub step: i32,
    pub body: Vec<Statement>,
}

/// Part of a switch: its labels (none: the default's), statements, and whether it goes on into the next.
#[derive(Clone)]
pub struct Case {
    pub labels: Vec<i32>,
    pub body: Vec<Statement>,
    pub falls: bool,
}

#[derive(Clone)]
pub enum Argument {
    In(Expr),
    /// `out`, or `inout`.
    Out(Place),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    In,
    Out,
    InOut,
}

/// A variable's name and type.
#[derive(Clone)]
pub struct Variable {
    pub name: String,
    pub kind: Type,
}

/// A function of the program.
#[derive(Clone)]
pub struct Own {
    pub name: String,
    /// Each a variable.
    pub parameters: Vec<(usize, Direction)>,
    pub result: Option<Type>,
    pub body: Vec<Statement>,
}

/// A program's trees.
#[derive(Clone, Default)]
pub struct Program {
    pub variables: Vec<Variable>,
    pub functions: Vec<Own>,
    pub body: Vec<Statement>,
}

const LETTERS: [&str; 3] = ["xyzw", "rgba", "stpq"];

impl Program {
    pub fn name(&self, variable: usize) -> &str {
        &self.variables[variable].name
    }

    pub fn expression(&self, expr: &Expr) -> String {
        let listed = |arguments: &[Expr]| -> String {
            let texts: Vec<String> = arguments.iter().map(|argument| self.expression(argument)).collect();
            texts.join(", ")
        };
        match &expr.form {
            Form::Literal(value) => literal_of(value, expr.kind),
            Form::Variable(variable) => self.name(*variable).to_owned(),
            Form::Call(function, arguments) => match (function.style, &arguments[..]) {
                (Style::Infix, [a, b]) => {
                    format!("({} {} {})", self.expression(a), function.name, self.expression(b))
                }
                (Style::Prefix, _) => format!("({}({}))", function.name, listed(arguments)),
                _ => format!("{}({})", function.name, listed(arguments)),
            },
            Form::Construct(arguments) if expr.kind.count > 0 => {
                format!("{}[{}]({})", expr.kind.name(), expr.kind.count, listed(arguments))
            }
            Form::Construct(arguments) => format!("{}({})", expr.kind.name(), listed(arguments)),
            Form::Select(parts) => {
                let [condition, first, second] = [0, 1, 2].map(|part| self.expression(&parts[part]));
                format!("({condition} ? {first} : {second})")
            }
            Form::Swizzle(inner, components) => format!("{}.{}", self.expression(inner), swizzle(components)),
            Form::Index(parts) => format!("{}[{}]", self.expression(&parts[0]), self.expression(&parts[1])),
            Form::Own(function, arguments) => format!("{}({})", self.functions[*function].name, listed(arguments)),
        }
    }

    fn place(&self, place: &Place) -> String {
        let index = place.index.as_ref().map(|index| format!("[{}]", self.expression(index)));
        let letters = if place.swizzle.is_empty() { String::new() } else { format!(".{}", swizzle(&place.swizzle)) };
        format!("{}{}{letters}", self.name(place.variable), index.unwrap_or_default())
    }

    pub fn statements(&self, list: &[Statement], depth: usize) -> String {
        list.iter().map(|statement| self.statement(statement, depth)).collect()
    }

    fn block(&self, list: &[Statement], depth: usize) -> String {
        format!("{{\n{}{}}}", self.statements(list, depth + 1), "    ".repeat(depth))
    }

    fn statement(&self, statement: &Statement, depth: usize) -> String {
        let text = match statement {
            Statement::Declare(variable, expr) => {
                format!("{} = {};", self.declaration(*variable), self.expression(expr))
            }
            Statement::Constant(variable, expr) => {
                format!("const {} = {};", self.declaration(*variable), self.expression(expr))
            }
            Statement::Assign(place, operator, expr) => {
                let operator = operator.map_or("", |operator| operator.name);
                format!("{} {operator}= {};", self.place(place), self.expression(expr))
            }
            Statement::If(condition, then, otherwise) => {
                let head = format!("if ({}) {}", self.expression(condition), self.block(then, depth));
                if otherwise.is_empty() { head } else { format!("{head} else {}", self.block(otherwise, depth)) }
            }
            Statement::For(turns) => {
                let Loop { first, step, .. } = turns;
                let (name, end) = (self.name(turns.counter), self.expression(&turns.end));
                let by = if *step == 1 { format!("++{name}") } else { format!("{name} += {step}") };
                let body = match &turns.body[..] {
                    [only @ Statement::For(_)] => format!("\n{}", self.statement(only, depth + 1).trim_end()),
                    several => format!(" {}", self.block(several, depth)),
                };
                format!("for (int {name} = {first}; {name} < {end}; {by}){body}")
            }
            Statement::While(turns) | Statement::DoWhile(turns) => {
                let Loop { first, step, .. } = turns;
                let (name, end) = (self.name(turns.counter), self.expression(&turns.end));
                // The counter goes on before the body, so that `continue` does not skip it.
                let inner = self.statements(&turns.body, depth + 1);
                let indent = "    ".repeat(depth);
                let body = format!("{{\n{indent}    {name} += {step};\n{inner}{indent}}}");
                match statement {
                    Statement::While(_) => format!("int {name} = {first};\n{indent}while ({name} < {end}) {body}"),
                    _ => format!("int {name} = {first};\n{indent}do {body} while ({name} < {end});"),
                }
            }
            Statement::Switch(expr, cases) => {
                let cases: String = cases.iter().map(|case| self.case(case, depth)).collect();
                format!("switch ({}) {{\n{cases}{}}}", self.expression(expr), "    ".repeat(depth))
            }
            Statement::Block(list) => self.block(list, depth),
            Statement::Break => "break;".to_owned(),
            Statement::Continue => "continue;".to_owned(),
            Statement::Return(None) => "return;".to_owned(),
            Statement::Return(Some(expr)) => format!("return {};", self.expression(expr)),
            Statement::Discard => "discard;".to_owned(),
            Statement::Call(result, function, arguments) => {
                let texts: Vec<String> = arguments
                    .iter()
                    .map(|argument| match argument {
                        Argument::In(expr) => self.expression(expr),
                        Argument::Out(place) => self.place(place),
                    })
                    .collect();
                let result = result.map_or(String::new(), |result| format!("{} = ", self.declaration(result)));
                format!("{result}{}({});", self.functions[*function].name, texts.join(", "))
            }
        };
        format!("{}{text}\n", "    ".repeat(depth))
    }

    fn case(&self, case: &Case, depth: usize) -> String {
        let indent = "    ".repeat(depth);
        let labels: String = match case.labels.is_empty() {
            true => format!("{indent}default:\n"),
            false => case.labels.iter().map(|label| format!("{indent}case {label}:\n")).collect(),
        };
        let end = if case.falls { String::new() } else { format!("{indent}    break;\n") };
        format!("{labels}{indent}    {}\n{end}", self.block(&case.body, depth + 1))
    }

    fn declaration(&self, variable: usize) -> String {
        let Variable { name, kind } = &self.variables[variable];
        let count = if kind.count > 0 { format!("[{}]", kind.count) } else { String::new() };
        format!("{} {name}{count}", kind.name())
    }

    /// The functions' texts, in the order in which they may call each other.
    pub fn functions(&self) -> String {
        let text = |own: &Own| {
            let parameter = |(variable, direction): &(usize, Direction)| {
                let word = match direction {
                    Direction::In => "",
                    Direction::Out => "out ",
                    Direction::InOut => "inout ",
                };
                format!("{word}{}", self.declaration(*variable))
            };
            let parameters: Vec<String> = own.parameters.iter().map(parameter).collect();
            let result = own.result.map_or("void".to_owned(), Type::name);
            format!("{result} {}({}) {}\n", own.name, parameters.join(", "), self.block(&own.body, 0))
        };
        self.functions.iter().map(text).collect()
    }
}

fn swizzle(components: &[usize]) -> String {
    let letters = LETTERS[components.iter().sum::<usize>() % LETTERS.len()];
    components.iter().map(|component| &letters[*component..=*component]).collect()
}

fn literal_of(value: &[Num], kind: Type) -> String {
    let texts: Vec<String> = value.iter().map(|x| literal(x.value, kind.base)).collect();
    match kind {
        Type { count: 1.., .. } => {
            let element = kind.element();
            let parts = value.chunks(element.scalars()).map(|part| literal_of(part, element));
            format!("{}[{}]({})", element.name(), kind.count, parts.collect::<Vec<_>>().join(", "))
        }
        _ if kind.is_scalar() => match value[0].value < 0.0 && kind.base != NumberBase::Uint {
            true => format!("({})", texts[0]),
            false => texts[0].clone(),
        },
        _ => format!("{}({})", kind.name(), texts.join(", ")),
    }
}
