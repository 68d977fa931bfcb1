//! Text into HTML: escaping, pictures as data. Knows no report.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Escapes text for elements and for attributes in double quotes.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // No document may hold them, not even as references.
            '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\x7f'..='\u{9f}' => escaped.push('\u{fffd}'),
            _ => escaped.push(letter),
        }
    }
    escaped
}

/// A picture with its caption, in the page itself.
pub(crate) fn figure(png: &[u8], [width, height]: [u32; 2], alt: &str, caption: &str) -> String {
    format!(
        "<figure><img width=\"{width}\" height=\"{height}\" alt=\"{}\" src=\"data:image/png;base64,{}\">\
         <figcaption>{}</figcaption></figure>\n",
        escape(alt),
        STANDARD.encode(png),
        escape(caption)
    )
}

/// `<ul>` of the items, or nothing without any.
pub(crate) fn list(items: impl IntoIterator<Item = String>) -> String {
    let items: String = items.into_iter().map(|item| format!("<li>{}</li>\n", escape(&item))).collect();
    if items.is_empty() { items } else { format!("<ul>\n{items}</ul>\n") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_escapes_escaping() {
        assert_eq!(escape("<a href=\"x\" id='y'>&\u{1}"), "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;&amp;\u{fffd}");
    }

    #[test]
    fn an_empty_list_is_nothing() {
        assert_eq!(list(Vec::new()), "");
    }
}
