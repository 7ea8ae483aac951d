//! Parses a module: the paths in it, its imports, and its child modules. Items for tests only are left out.

use proc_macro2::{Ident, TokenStream, TokenTree};
use std::collections::BTreeSet;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, Stmt, UseTree, Visibility};

/// A path of two or more segments, or the path of an import, with its line.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) path: Vec<String>,
    pub(crate) line: usize,
}

/// One imported name of a `use` item.
#[derive(Clone, Debug)]
pub(crate) struct Import {
    /// The name that it has in this module; `*` for all names of a module.
    pub(crate) name: String,
    pub(crate) named: Named,
    /// Whether it is visible to other modules, as with `pub use`.
    pub(crate) is_export: bool,
}

/// A child module in a file of its own.
#[derive(Debug)]
pub(crate) struct Child {
    pub(crate) name: String,
    /// The file given by `#[path = "…"]`.
    pub(crate) file: Option<String>,
}

/// A module without its items for tests.
#[derive(Debug, Default)]
pub(crate) struct Module {
    /// Names from the crate's root to this module.
    pub(crate) path: Vec<String>,
    pub(crate) imports: Vec<Import>,
    pub(crate) named: Vec<Named>,
    /// Names of the items that are defined here.
    pub(crate) defined: BTreeSet<String>,
    pub(crate) children: Vec<Child>,
}

/// Parses a file that contains the module at `path`: returns this module and those nested in the file.
///
/// # Errors
/// The line and message of a syntax error.
pub(crate) fn read(path: &[String], source: &str) -> Result<Vec<Module>, String> {
    let file = syn::parse_file(source).map_err(|error| format!("{}: {error}", error.span().start().line))?;
    let mut reader = Reader { open: vec![Module { path: path.to_vec(), ..Module::default() }], closed: Vec::new() };
    reader.visit_file(&file);
    reader.closed.append(&mut reader.open);
    Ok(reader.closed)
}

struct Reader {
    /// The module that is being read, as the last element, and the modules around it.
    open: Vec<Module>,
    closed: Vec<Module>,
}

impl Reader {
    fn module(&mut self) -> &mut Module {
        self.open.last_mut().expect("the file's own module stays open")
    }

    fn name(&mut self, path: Vec<String>, line: usize) {
        if path.len() > 1 {
            self.module().named.push(Named { path, line });
        }
    }

    /// Adds all names of a `use` tree.
    fn import(&mut self, before: &[String], tree: &UseTree, is_export: bool) {
        let with = |segment: &Ident| [before, &[segment.to_string()]].concat();
        let (name, path, span) = match tree {
            UseTree::Path(path) => return self.import(&with(&path.ident), &path.tree, is_export),
            UseTree::Group(group) => return group.items.iter().for_each(|tree| self.import(before, tree, is_export)),
            // `use a::b::{self}` imports `a::b`.
            UseTree::Name(leaf) if leaf.ident == "self" => {
                (before.last().cloned().unwrap_or_default(), before.to_vec(), leaf.ident.span())
            }
            UseTree::Name(leaf) => (leaf.ident.to_string(), with(&leaf.ident), leaf.ident.span()),
            UseTree::Rename(leaf) if leaf.ident == "self" => {
                (leaf.rename.to_string(), before.to_vec(), leaf.ident.span())
            }
            UseTree::Rename(leaf) => (leaf.rename.to_string(), with(&leaf.ident), leaf.ident.span()),
            UseTree::Glob(glob) => ("*".to_owned(), before.to_vec(), glob.star_token.spans[0]),
        };
        let named = Named { path, line: span.start().line };
        self.module().imports.push(Import { name, named, is_export });
    }

    /// Adds the paths in the tokens of a macro, which are not parsed otherwise.
    fn scan(&mut self, tokens: TokenStream) {
        let (mut path, mut line, mut colons) = (Vec::new(), 0, 0);
        for token in tokens {
            match token {
                TokenTree::Ident(segment) => {
                    if colons != 2 {
                        self.name(std::mem::take(&mut path), line);
                    }
                    line = segment.span().start().line;
                    path.push(segment.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                other => {
                    self.name(std::mem::take(&mut path), line);
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.scan(group.stream());
                    }
                }
            }
        }
        self.name(path, line);
    }
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast Item) {
        if attributes(item).iter().any(is_for_tests) {
            return;
        }
        match item {
            Item::Const(item) => self.define(&item.ident),
            Item::Enum(item) => self.define(&item.ident),
            Item::Fn(item) => self.define(&item.sig.ident),
            Item::Static(item) => self.define(&item.ident),
            Item::Struct(item) => self.define(&item.ident),
            Item::Trait(item) => self.define(&item.ident),
            Item::Type(item) => self.define(&item.ident),
            Item::Union(item) => self.define(&item.ident),
            _ => {}
        }
        visit::visit_item(self, item);
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        let attributes: &[Attribute] = match item {
            ImplItem::Const(item) => &item.attrs,
            ImplItem::Fn(item) => &item.attrs,
            ImplItem::Type(item) => &item.attrs,
            ImplItem::Macro(item) => &item.attrs,
            _ => &[],
        };
        if !attributes.iter().any(is_for_tests) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        let for_tests = matches!(statement, Stmt::Local(local) if local.attrs.iter().any(is_for_tests));
        if !for_tests {
            visit::visit_stmt(self, statement);
        }
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        let name = item.ident.to_string();
        let Some((_, items)) = &item.content else {
            let file = item.attrs.iter().find_map(given_path);
            self.module().children.push(Child { name, file });
            return;
        };
        let mut path = self.module().path.clone();
        path.push(name);
        self.open.push(Module { path, ..Module::default() });
        items.iter().for_each(|item| self.visit_item(item));
        self.closed.extend(self.open.pop());
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&[], &item.tree, !matches!(item.vis, Visibility::Inherited));
    }

    /// The path in `pub(in …)` does not count as a use.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let line = path.segments.first().map_or(0, |segment| segment.ident.span().start().line);
        self.name(path.segments.iter().map(|segment| segment.ident.to_string()).collect(), line);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invoked: &'ast syn::Macro) {
        visit::visit_macro(self, invoked);
        self.scan(invoked.tokens.clone());
    }
}

impl Reader {
    fn define(&mut self, name: &Ident) {
        self.module().defined.insert(name.to_string());
    }
}

/// Whether an attribute is `#[cfg(test)]`, or `#[cfg(all(…))]` with `test` among them.
fn is_for_tests(attribute: &Attribute) -> bool {
    let Ok(condition) = attribute.parse_args::<syn::Meta>() else { return false };
    let all = condition.path().is_ident("all").then(|| condition.require_list().ok()).flatten();
    let among = all.is_some_and(|list| {
        let parser = syn::punctuated::Punctuated::<syn::Meta, syn::Token![,]>::parse_terminated;
        list.parse_args_with(parser).is_ok_and(|all| all.iter().any(|one| one.path().is_ident("test")))
    });
    attribute.path().is_ident("cfg") && (condition.path().is_ident("test") || among)
}

/// The file given by `#[path = "…"]`.
fn given_path(attribute: &Attribute) -> Option<String> {
    let pair = attribute.meta.require_name_value().ok().filter(|pair| pair.path.is_ident("path"))?;
    let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) = &pair.value else { return None };
    Some(text.value())
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(syn::ItemConst { attrs, .. })
        | Item::Enum(syn::ItemEnum { attrs, .. })
        | Item::ExternCrate(syn::ItemExternCrate { attrs, .. })
        | Item::Fn(syn::ItemFn { attrs, .. })
        | Item::ForeignMod(syn::ItemForeignMod { attrs, .. })
        | Item::Impl(syn::ItemImpl { attrs, .. })
        | Item::Macro(syn::ItemMacro { attrs, .. })
        | Item::Mod(syn::ItemMod { attrs, .. })
        | Item::Static(syn::ItemStatic { attrs, .. })
        | Item::Struct(syn::ItemStruct { attrs, .. })
        | Item::Trait(syn::ItemTrait { attrs, .. })
        | Item::Type(syn::ItemType { attrs, .. })
        | Item::Union(syn::ItemUnion { attrs, .. })
        | Item::Use(syn::ItemUse { attrs, .. }) => attrs,
        _ => &[],
    }
}
