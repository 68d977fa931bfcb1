//! Words for several GL functions.

/// Functions that one word stands for.
const GROUPS: [(&str, &[&str]); 4] = [
    ("draw", &["glDrawArrays", "glDrawArraysInstanced", "glDrawElements", "glDrawElementsInstanced"]),
    ("drawn", &["glDrawArrays", "glDrawArraysInstanced", "glDrawElements", "glDrawElementsInstanced", "glEnd"]),
    ("clear", &["glClear", "glClearBufferfv", "glClearBufferiv", "glClearBufferfi"]),
    ("copy", &["glCopyTexSubImage2D", "glCopyTexImage2D"]),
];

/// Functions with those that a group's word stands for.
pub fn whole(functions: &[&'static str]) -> Vec<&'static str> {
    let members = |name: &&'static str| match GROUPS.iter().find(|(group, _)| group == name) {
        Some((_, members)) => members.to_vec(),
        None => vec![*name],
    };
    functions.iter().flat_map(members).collect()
}
