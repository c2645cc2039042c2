//! The few elements of HTML that a report needs.

use std::fmt::Write;

const STYLE: &str = "\
body{font:15px/1.5 system-ui,sans-serif;max-width:1080px;margin:2em auto;padding:0 1em;color:#1f2933}\
h1,h2,h3{line-height:1.2}h2{margin-top:2em;border-bottom:1px solid #cbd2d9}\
table{border-collapse:collapse;margin:1em 0;font-size:13px}\
th,td{border:1px solid #cbd2d9;padding:3px 8px;text-align:left;vertical-align:top}\
th{background:#f0f3f6}svg{max-width:100%;height:auto}figure{margin:1.5em 0}\
.reproduced{background:#d5eedb}.not{background:#f6d3cf}.undecided{background:#eceff3}\
code{background:#f0f3f6;padding:0 3px}small{color:#52606d}details{margin:.4em 0}";

/// A page in the making.
#[derive(Debug, Default)]
pub(super) struct Page {
    body: String,
}

impl Page {
    pub(super) fn heading(&mut self, level: u8, text: &str) {
        let _ = writeln!(self.body, "<h{level}>{}</h{level}>", escaped(text));
    }

    /// Adds a mark that links of the page can lead to.
    pub(super) fn anchor(&mut self, id: &str) {
        let _ = writeln!(self.body, "<a id=\"{id}\"></a>");
    }

    /// Adds links in a row: texts with their targets.
    pub(super) fn links(&mut self, before: &str, links: &[(String, String)]) {
        let link = |(text, to): &(String, String)| {
            format!("<a href=\"{}\">{}</a>", escaped(to).replace('"', "&quot;"), escaped(text))
        };
        let links: Vec<String> = links.iter().map(link).collect();
        if !links.is_empty() {
            let _ = writeln!(self.body, "<p>{}{}</p>", escaped(before), links.join(" · "));
        }
    }

    pub(super) fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// Adds a table. Verdicts have a colour; a text `#place` is a link to the place on the page, and shows
    /// what follows the last hyphen of its name.
    pub(super) fn table(&mut self, columns: &[&str], rows: &[Vec<String>]) {
        let cells = |tag: &str, cells: &mut dyn Iterator<Item = &str>| {
            let cell = |text: &str| {
                let class = match text {
                    "reproduced" => " class=\"reproduced\"",
                    "not reproduced" => " class=\"not\"",
                    "undecided" => " class=\"undecided\"",
                    _ => "",
                };
                let shown = escaped(text);
                let shown = match text.strip_prefix('#').and_then(|place| place.rsplit_once('-')) {
                    Some((_, name)) => format!("<a href=\"{shown}\">{}</a>", escaped(name)),
                    None => shown,
                };
                format!("<{tag}{class}>{shown}</{tag}>")
            };
            cells.map(cell).collect::<String>()
        };
        let head = cells("th", &mut columns.iter().copied());
        let _ = writeln!(self.body, "<table><tr>{head}</tr>");
        for row in rows {
            let row = cells("td", &mut row.iter().map(String::as_str));
            let _ = writeln!(self.body, "<tr>{row}</tr>");
        }
        self.body.push_str("</table>\n");
    }

    pub(super) fn list(&mut self, items: &[String]) {
        let items: String = items.iter().map(|i| format!("<li>{}</li>", escaped(i))).collect();
        if !items.is_empty() {
            let _ = writeln!(self.body, "<ul>{items}</ul>");
        }
    }

    /// Adds a drawing as it is.
    pub(super) fn drawing(&mut self, svg: &str) {
        // The text before the drawing is for files only.
        let svg = svg.find("<svg").map_or(svg, |at| &svg[at..]);
        let _ = writeln!(self.body, "<figure>{svg}</figure>");
    }

    pub(super) fn finish(self, title: &str) -> String {
        format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>\
             <style>{STYLE}</style></head>\n<body>\n{}</body></html>\n",
            escaped(title),
            self.body
        )
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_verdicts_are_coloured() {
        let mut page = Page::default();
        page.table(&["H < ε"], &[vec!["not reproduced".to_owned()], vec!["#claim-5".to_owned()]]);
        page.links("See ", &[("a < b".to_owned(), "figure\"1.csv".to_owned())]);
        let html = page.finish("a & b");
        assert!(html.contains("<th>H &lt; ε</th>") && html.contains("<title>a &amp; b</title>"));
        assert!(html.contains("<td class=\"not\">not reproduced</td>"));
        assert!(html.contains("<td><a href=\"#claim-5\">5</a></td>"));
        assert!(html.contains("<p>See <a href=\"figure&quot;1.csv\">a &lt; b</a></p>"));
    }
}
