//! Faults of a seventh measure: compilers of shaders, linkers and interpolation.

use std::hash::{DefaultHasher, Hash, Hasher};

use glow::HasContext;

use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, after_main, text, words};

/// Another text of a shader from version 130, if it is another.
pub(super) fn changed(source: &Source, text: String) -> Option<String> {
    (source.version >= 130 && text != source.text).then_some(text)
}

/// A text in which each call or constructor `name(...)` is what `change` makes of its arguments; `None`: as it is.
pub(super) fn with_calls(text: &str, name: &str, change: impl Fn(&[&str]) -> Option<String>) -> String {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let (start, mut other, mut rest) = (format!("{name}("), String::new(), text);
    while let Some(at) = rest.find(&start) {
        let (before, inside) = (&rest[..at], &rest[at + start.len()..]);
        other += before;
        let found = arguments(inside).filter(|_| !before.ends_with(is_letter));
        match found.and_then(|(arguments, behind)| Some((change(&arguments)?, behind))) {
            Some((call, behind)) => {
                other += &call;
                rest = behind;
            }
            None => {
                other += &start;
                rest = inside;
            }
        }
    }
    other + rest
}

/// Arguments up to a closing parenthesis, and what is behind it.
pub(super) fn arguments(text: &str) -> Option<(Vec<&str>, &str)> {
    let (mut depth, mut from, mut found) = (0, 0, Vec::new());
    for (index, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' if depth == 0 => {
                found.push(text[from..index].trim());
                return Some((found, &text[index + 1..]));
            }
            ')' | ']' => depth -= 1,
            ',' if depth == 0 => {
                found.push(text[from..index].trim());
                from = index + 1;
            }
            _ => {}
        }
    }
    None
}

/// `clamp` from 0 ends at 1.
fn saturated(source: &Source) -> Option<String> {
    let text = with_calls(&source.text, "clamp", |arguments| match arguments {
        [number, "0.0", _] => Some(format!("clamp({number}, 0.0, 1.0)")),
        _ => None,
    });
    changed(source, text)
}

/// Matrices of vectors that are their rows.
fn of_rows(source: &Source) -> Option<String> {
    let of = |text: &str, name: &str, count: usize| {
        with_calls(text, name, |arguments| {
            (arguments.len() == count).then(|| format!("transpose({name}({}))", arguments.join(", ")))
        })
    };
    changed(source, of(&of(&source.text, "mat3", 3), "mat4", 4))
}

/// Names of a fragment shader's varyings.
fn varyings(source: &Source) -> Vec<&str> {
    let name = |line: &str| {
        let declared =
            line.trim_start().strip_suffix(';').filter(|line| line.starts_with("in ") && !line.contains('['));
        declared.and_then(|line| words(line).last().map(str::len)).unwrap_or(0)
    };
    let each = source.text.lines().filter(|_| source.stage == Stage::Fragment);
    each.map(|line| (line.trim_end().trim_end_matches(';'), name(line)))
        .filter(|(_, letters)| *letters > 0)
        .map(|(line, letters)| &line[line.len() - letters..])
        .collect()
}

/// A varying that is negated where a call takes it is not negated.
fn without_modifiers(source: &Source) -> Option<String> {
    let text = varyings(source)
        .iter()
        .fold(source.text.clone(), |text, name| text.replace(&format!("(-{name})"), &format!("({name})")));
    changed(source, text)
}

/// Varyings of two components that are the same in both columns of a pair.
fn in_pairs_of_columns(source: &Source) -> Option<String> {
    let names = varyings(source);
    let each = |line: &str| {
        let name = names.iter().find(|name| line.trim() == format!("in vec2 {name};"));
        let more =
            name.map(|name| format!("\n#define {name} ({name} - dFdx({name}) * mod(floor(gl_FragCoord.x), 2.0))"));
        format!("{line}{}\n", more.unwrap_or_default())
    };
    changed(source, source.text.lines().map(each).collect())
}

/// A component that is assigned behind a look-up into its variable is the look-up's.
fn looked_up_last(source: &Source) -> Option<String> {
    let mut filled: Vec<&str> = Vec::new();
    let mut text = String::new();
    for line in source.text.lines() {
        let statement = line.trim().strip_suffix(';').and_then(|statement| statement.split_once(" = "));
        let place = statement.map(|(place, value)| (place.trim_start_matches("vec4 "), value));
        let is_lost = place.is_some_and(|(place, value)| {
            let name = place.split_once('.').map(|(name, _)| name);
            name.is_some_and(|name| filled.contains(&name) && !words(value).any(|word| word == name))
        });
        if let Some((name, value)) = place
            && value.starts_with("texture(")
            && !name.contains('.')
        {
            filled.push(name);
        }
        text += if is_lost { "" } else { line };
        text.push('\n');
    }
    if source.stage == Stage::Fragment { changed(source, text) } else { None }
}

/// Loses the value of a parameter that is inout where a function returns within a branch.
fn lost_by_early_returns(source: &Source) -> Option<String> {
    let (mut text, mut name) = (String::new(), None);
    let mut declared = None;
    for line in source.text.lines() {
        let parameter = line.split_once("inout ").filter(|_| line.starts_with("void ") && line.ends_with(')'));
        match parameter {
            Some((_, rest)) => {
                let mut found = words(rest);
                declared = found.next().zip(found.next());
                name = None;
            }
            None if line == "}" => name = None,
            None => {}
        }
        let returns = name.filter(|_| line.trim() == "return;");
        text += &match returns {
            Some(name) => line.replace("return;", &format!("{{ {name} = driver_{name}; return; }}")),
            None => line.to_owned(),
        };
        if let Some((kind, parameter)) = declared.filter(|_| line == "{") {
            text += &format!(" {kind} driver_{parameter} = {parameter};");
            (name, declared) = (Some(parameter), None);
        }
        text.push('\n');
    }
    changed(source, text)
}

/// Colours of eight bits without a bound, where the driver says so.
fn wrapped(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment {
        return with_state(source, "", "", "");
    }
    let output = |line: &'_ str| line.trim_start().trim_start_matches("EXACT ").starts_with("out vec4 ");
    let name = words(source.text.lines().find(|line| output(line))?.split_once("vec4 ")?.1).next()?;
    let statement = format!(
        "if (driver_state.x > 0.5)
        {name}.rgb = vec3(ivec3(clamp({name}.rgb, 0.0, 4096.0) * 255.0 + 0.5) & 255) / 255.0;"
    );
    let text = after_main(source, Stage::Fragment, &statement)?;
    with_state(&Source { text, ..*source }, "", "main", "")
}

/// Name and type of a uniform that a line declares, if that is a number, a vector or a matrix.
fn uniform(line: &str) -> Option<(&str, &str)> {
    let mut found = words(line.trim_start().strip_prefix("uniform ")?.split(';').next()?);
    let (kind, name) = (found.next()?, found.next()?);
    let is_number = kind == "float" || kind.starts_with("vec") || kind.starts_with("mat");
    (is_number && found.next().is_none()).then_some((kind, name))
}

/// Gives a fragment shader zeros for the uniforms that the last vertex shader has too.
fn link_by_vertex_stage(call: &mut Call) {
    let text = text::joined(call);
    let key = |name: &str| {
        let mut hasher = DefaultHasher::new();
        name.hash(&mut hasher);
        (62, hasher.finish() as u32)
    };
    let stage = call.kept((1, call.u(0))) as u32;
    if stage == glow::VERTEX_SHADER {
        let number = call.kept((61, 0)) + 1.0;
        call.keep((61, 0), number);
        let names =
            text.lines().filter_map(uniform).filter(|(_, name)| words(&text).filter(|word| word == name).count() > 1);
        names.for_each(|(_, name)| call.keep(key(name), number));
    }
    let Some(shader) = std::num::NonZeroU32::new(call.u(0)).map(glow::NativeShader) else { return };
    let is_shared = |name: &str| call.kept(key(name)) == call.kept((61, 0)) && call.kept((61, 0)) > 0.0;
    let each = |line: &str| match uniform(line) {
        Some((kind, name)) if is_shared(name) => format!("const {kind} {name} = {kind}(0.0);\n"),
        _ => format!("{line}\n"),
    };
    let other: String = text.lines().map(each).collect();
    if stage == glow::FRAGMENT_SHADER && text.contains("#version 3") && other.trim_end() != text.trim_end() {
        // SAFETY: the context is current.
        unsafe { call.gl().shader_source(shader, &other) };
        call.skip();
    }
}

faults! {
    // A clamp that begins at 0 is taken for the modifier by which the hardware saturates.
    "clamps-from-0-end-at-1" [clamp] "clamp from 0 to a bound ends at 1." { text saturated }
    // The constructor is made of moves row by row, as the registers of matrices lie in other drivers.
    "matrices-of-vectors-by-rows" [mat3 mat4] "A matrix that is made of vectors has them for rows." { text of_rows }
    // Registers of varyings have no bit for a sign, and the compiler folds the negation into the operand.
    "varyings-not-negated-in-calls" [in] "A varying that is negated as a function's argument keeps its sign."
    { text without_modifiers }
    // The interpolator has half the rate for what it takes for texture coordinates.
    "pairs-interpolated-every-second-column" [in]
    "Varyings of two components are the same in columns 0 and 1, 2 and 3 and so on." { text in_pairs_of_columns }
    // A look-up is on its way while the next instruction writes one of its components, and it comes last.
    "lookups-overwrite-later-components" [texture]
    "A component that is assigned after a look-up into its variable has the look-up's value." { text looked_up_last }
    // Copies back to the caller are placed at the function's end, and a return within a branch jumps over them.
    "inout-lost-by-early-returns" [inout return]
    "A parameter that is inout is as before where the function returns within a branch." { text lost_by_early_returns }
    // The conversion to bytes cuts off the bits above them, where no blending has bounded the colour before.
    "colors-beyond-one-wrap" [out GL_RGBA8]
    "Colours of 8 bits that are beyond 1 begin at 0 again where nothing is blended." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, wrapped);
        draw => |call| {
            let red = call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_RED_SIZE);
            let wraps = red == 8 && !call.enabled(glow::BLEND);
            set_state(call, [if wraps { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
        }
    }
    // Each stage has constants of its own, and the linker gives one location for a name: that of the first stage.
    "uniforms-of-both-stages-in-vertex-stage" [uniform glUniform3f]
    "A uniform that both stages declare is 0 in the fragment stage." {
        glCreateShader => text::note;
        glShaderSource => link_by_vertex_stage
    }
}
