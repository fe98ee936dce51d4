//! Doc comments and helper attributes, read from an item.

use proc_macro2::{Group, Span, TokenStream};
use quote::{ToTokens, quote};
use syn::meta::ParseNestedMeta;
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::token::Bracket;
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, ExprLit, Field, Ident, Lit, Meta, Result, Token,
};

/// The text of an item's doc comment.
pub(crate) fn doc(attributes: &[Attribute], span: Span, what: &str) -> Result<String> {
    let mut lines = Vec::new();
    for attribute in attributes {
        if let Meta::NameValue(pair) = &attribute.meta
            && pair.path.is_ident("doc")
            && let Expr::Lit(ExprLit {
                lit: Lit::Str(text),
                ..
            }) = &pair.value
        {
            let line = text.value();
            lines.push(
                line.strip_prefix(' ')
                    .unwrap_or(&line)
                    .trim_end()
                    .to_owned(),
            );
        }
    }
    let text = lines.join("\n").trim().to_owned();
    if text.is_empty() {
        return Err(Error::new(
            span,
            format!("{what} needs a doc comment: it is its reference page"),
        ));
    }
    Ok(text)
}

/// Calls `read` for each argument of every `#[name(...)]` among `attributes`.
pub(crate) fn each(
    attributes: &[Attribute],
    name: &str,
    mut read: impl FnMut(ParseNestedMeta<'_>) -> Result<()>,
) -> Result<()> {
    let named = attributes
        .iter()
        .filter(|attribute| attribute.path().is_ident(name));
    named
        .into_iter()
        .try_for_each(|attribute| attribute.parse_nested_meta(&mut read))
}

/// The named fields of a struct.
pub(crate) fn fields(item: &DeriveInput) -> Result<Vec<(&Ident, &Field)>> {
    let Data::Struct(data) = &item.data else {
        return Err(Error::new(
            item.ident.span(),
            "only structs with named fields can derive this",
        ));
    };
    let named = data
        .fields
        .iter()
        .filter_map(|field| Some((field.ident.as_ref()?, field)));
    Ok(named.collect())
}

/// How a default is written.
pub(crate) enum Default {
    /// A bare identifier: a variant of the input's own type.
    Variant(Ident),
    /// Anything else, as it stands.
    Tokens(TokenStream),
}

impl Default {
    fn read(input: ParseStream<'_>) -> Result<Self> {
        if input.peek(Bracket) {
            return Ok(Self::Tokens(input.parse::<Group>()?.into_token_stream()));
        }
        let expr: Expr = input.parse()?;
        Ok(match &expr {
            Expr::Path(path) if path.path.get_ident().is_some() => {
                Self::Variant(path.path.require_ident()?.clone())
            }
            _ => Self::Tokens(expr.into_token_stream()),
        })
    }
}

/// What `#[input(...)]` or `#[output(...)]` says about a field.
#[derive(std::default::Default)]
pub(crate) struct Options {
    pub(crate) default: Option<Default>,
    pub(crate) min: Option<Expr>,
    pub(crate) above: Option<Expr>,
    pub(crate) max: Option<Expr>,
    pub(crate) quantity: Option<TokenStream>,
    pub(crate) free: Vec<TokenStream>,
    pub(crate) attributes: bool,
    pub(crate) only_with: Option<(Ident, Vec<Ident>)>,
    /// A count of faults, and the input without which it counts none.
    pub(crate) faults: Option<Option<Ident>>,
}

impl Options {
    /// Reads every `#[name(...)]` among `attributes`.
    pub(crate) fn read(attributes: &[Attribute], name: &str) -> Result<Self> {
        let mut options = <Self as std::default::Default>::default();
        each(attributes, name, |meta| options.read_one(&meta))?;
        Ok(options)
    }

    fn read_one(&mut self, meta: &ParseNestedMeta<'_>) -> Result<()> {
        let Some(key) = meta.path.get_ident().map(ToString::to_string) else {
            return Err(meta.error("unknown attribute"));
        };
        match key.as_str() {
            "default" => self.default = Some(Default::read(meta.value()?)?),
            "min" => self.min = Some(meta.value()?.parse()?),
            "above" => self.above = Some(meta.value()?.parse()?),
            "max" => self.max = Some(meta.value()?.parse()?),
            "unit" => self.quantity = Some(quantity(&meta.value()?.parse()?)?),
            "attributes" => self.attributes = true,
            "faults" if meta.input.peek(Token![=]) => {
                self.faults = Some(Some(meta.value()?.parse()?));
            }
            "faults" => self.faults = Some(None),
            "free" => meta.parse_nested_meta(|name| {
                let Some(ident) = name.path.get_ident() else {
                    return Err(name.error("a name"));
                };
                let text = ident.to_string();
                let quantity = if name.input.peek(Token![:]) {
                    name.input.parse::<Token![:]>()?;
                    quantity(&name.input.parse()?)?
                } else {
                    quote!(::tessgraph_graph::Quantity::Number)
                };
                self.free.push(quote! {
                    ::tessgraph_graph::node::FreeName { name: #text, quantity: #quantity }
                });
                Ok(())
            })?,
            "only_with" => meta.parse_nested_meta(|choice| {
                let Some(ident) = choice.path.get_ident() else {
                    return Err(choice.error("a name"));
                };
                let value = choice.value()?;
                let names = Punctuated::<Ident, Token![|]>::parse_separated_nonempty(value)?;
                self.only_with = Some((ident.clone(), names.into_iter().collect()));
                Ok(())
            })?,
            _ => return Err(meta.error("unknown attribute")),
        }
        Ok(())
    }

    /// The quantity, a plain number if none is stated.
    pub(crate) fn quantity(&self) -> TokenStream {
        self.quantity
            .clone()
            .unwrap_or_else(|| quote!(::tessgraph_graph::Quantity::Number))
    }
}

fn quantity(name: &Ident) -> Result<TokenStream> {
    Ok(match name.to_string().as_str() {
        "length" => quote!(::tessgraph_graph::Quantity::Length),
        "area" => quote!(::tessgraph_graph::Quantity::Area),
        "volume" => quote!(::tessgraph_graph::Quantity::Volume),
        "angle" => quote!(::tessgraph_graph::Quantity::Angle),
        _ => {
            return Err(Error::new(
                name.span(),
                "expected length, area, volume or angle",
            ));
        }
    })
}
