//! The lists of clauses, and the mistakes in `docs/dsl.md` and `docs/reference.md`: each block that must not compile
//! fails with the error and on the line of its comment. (Doctests check that the other blocks run, and that these fail.)

use proc_macro2::TokenStream;
use vi_codegen::syntax;

const PAGES: [&str; 2] = [include_str!("../../../docs/dsl.md"), include_str!("../../../docs/reference.md")];

/// The errors of a system: (line, error, help).
fn errors(body: &str) -> Vec<(usize, String, String)> {
    let tokens: TokenStream = body.parse().expect("a block is made of Rust tokens");
    let result = syntax::parse::system(tokens).and_then(|system| vi_codegen::derive(&system)).map(|_| ());
    let errors = result.expect_err("a block that is marked so does not compile");
    let split = |error: syn::Error| {
        let text = error.to_string();
        let (what, help) = text.split_once("\nhelp: ").expect("every message has its help");
        (error.span().start().line, what.to_owned(), help.to_owned())
    };
    errors.into_iter().map(split).collect()
}

#[test]
fn every_shown_mistake_is_reported_at_its_comment() {
    let blocks: Vec<&str> = PAGES.iter().flat_map(|page| page.split("```rust,compile_fail\n").skip(1)).collect();
    assert!(blocks.len() >= 7, "{} blocks", blocks.len());
    for block in blocks {
        let block = block.split("```").next().expect("a block");
        let body = block.trim().strip_prefix("vi_core::lagrangian! {\n").and_then(|body| body.strip_suffix('}'));
        let body = body.expect("a block is one `vi_core::lagrangian!`");
        let (line, comment) = body
            .lines()
            .enumerate()
            .find_map(|(index, line)| line.split_once("// error: ").map(|(_, comment)| (index + 1, comment)))
            .expect("a block names its error");
        let (what, help) = comment.split_once("; help: ").unwrap_or((comment, ""));
        let (found_line, found, found_help) = errors(body).into_iter().next().expect("an error");
        assert_eq!((found_line, found.as_str()), (line, what), "{block}");
        assert!(found_help.starts_with(help.trim_end_matches(" …")), "{found_help}\nnot {help}");
    }
}

#[test]
fn each_clause_is_in_each_list() {
    let reference = |clause: &str| PAGES[1].contains(&format!("`{clause} "));
    let editor = |clause: &str| include_str!("../../../page/web/editor.js").contains(&format!(" {clause} "));
    for clause in vi_codegen::clause::words() {
        assert!(reference(clause), "`docs/reference.md` has no row for `{clause}`");
        assert!(editor(clause), "the editor of the page does not know `{clause}`");
    }
}
