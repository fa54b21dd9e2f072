//! Lengths of functions.

use syn::visit::{self, Visit};

use super::is_test;

/// Longest function of a library, in lines from `fn` to its closing brace.
const LONGEST_FUNCTION: usize = 60;

/// One line for each function of `text` that is too long.
pub(super) fn too_long(shown: &str, text: &str) -> Result<Vec<String>, String> {
    let parsed = syn::parse_file(text).map_err(|e| format!("{shown}: {e}"))?;
    let mut found = Lengths {
        shown,
        faults: Vec::new(),
    };
    found.visit_file(&parsed);
    Ok(found.faults)
}

struct Lengths<'a> {
    shown: &'a str,
    faults: Vec<String>,
}

impl Lengths<'_> {
    fn look(&mut self, signature: &syn::Signature, body: &syn::Block) {
        let start = signature.fn_token.span.start().line;
        let lines = body.brace_token.span.close().end().line + 1 - start;
        if lines > LONGEST_FUNCTION {
            self.faults.push(format!(
                "{}:{start}: `{}` has {lines} lines, more than {LONGEST_FUNCTION}",
                self.shown, signature.ident
            ));
        }
    }
}

impl<'ast> Visit<'ast> for Lengths<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.look(&item.sig, &item.block);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.look(&item.sig, &item.block);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_functions_are_seen_and_tests_may_be_long() {
        let body = "    let _ = 0;\n".repeat(LONGEST_FUNCTION);
        let long = format!("fn long() {{\n{body}}}\n");
        assert_eq!(too_long("x.rs", &long).unwrap().len(), 1);
        let test = format!("#[cfg(test)]\nmod tests {{\n{long}}}\n");
        assert!(too_long("x.rs", &test).unwrap().is_empty());
    }
}
