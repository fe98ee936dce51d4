//! `#[derive(Inputs)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Expr, Field, Ident, Result};

use crate::attributes::{self, Default, Options};

pub(crate) fn expand(item: &DeriveInput) -> Result<TokenStream> {
    let ident = &item.ident;
    let name = ident.to_string();
    let doc = attributes::doc(&item.attrs, ident.span(), "a node")?;
    let fields = attributes::fields(item)?;
    let specs = fields
        .iter()
        .map(|(name, field)| spec(name, field))
        .collect::<Result<Vec<_>>>()?;
    let binds = fields.iter().enumerate().map(|(index, (name, _))| {
        quote!(#name: args.take(&<Self as ::tessgraph_graph::Inputs>::INPUTS[#index])?)
    });
    Ok(quote! {
        impl ::tessgraph_graph::Inputs for #ident {
            const NAME: &'static str = #name;
            const DOC: &'static str = #doc;
            const INPUTS: &'static [::tessgraph_graph::node::InputSpec] = &[#(#specs),*];

            fn bind(
                args: &mut ::tessgraph_graph::Args,
            ) -> ::core::result::Result<Self, ::tessgraph_graph::NodeError> {
                Ok(Self { #(#binds),* })
            }
        }
    })
}

fn spec(ident: &Ident, field: &Field) -> Result<TokenStream> {
    let name = ident.to_string();
    let doc = attributes::doc(&field.attrs, ident.span(), "an input")?;
    let options = Options::read(&field.attrs, "input")?;
    let ty = &field.ty;
    let port = quote!(<#ty as ::tessgraph_graph::value::InputType>);
    let literal = match &options.default {
        None => None,
        Some(Default::Variant(variant)) => Some(quote!(<#ty>::#variant)),
        Some(Default::Tokens(tokens)) => Some(tokens.clone()),
    };
    let default = match literal {
        None => quote!(None),
        Some(literal) => quote! {
            Some(|| <#ty as ::tessgraph_graph::value::InputDefault>::default_value(#literal))
        },
    };
    let number = |bound: &Option<Expr>, otherwise: TokenStream| match bound {
        Some(expr) => quote!(Some((#expr) as f64)),
        None => otherwise,
    };
    let above = number(&options.above, quote!(None));
    let lowest = if options.above.is_some() {
        quote!(None)
    } else {
        quote!(#port::MIN)
    };
    let (min, max) = (
        number(&options.min, lowest),
        number(&options.max, quote!(#port::MAX)),
    );
    let quantity = options.quantity();
    let (free, with_attributes) = (&options.free, options.attributes);
    let only_with = match &options.only_with {
        None => quote!(None),
        Some((choice, names)) => {
            let choice = choice.to_string();
            let names = names.iter().map(ToString::to_string);
            quote!(Some((#choice, &[#(#names),*])))
        }
    };
    Ok(quote! {
        ::tessgraph_graph::node::InputSpec {
            name: #name,
            doc: #doc,
            kind: #port::KIND,
            quantity: #quantity,
            optional: #port::OPTIONAL,
            default: #default,
            min: #min,
            above: #above,
            max: #max,
            choices: #port::CHOICES,
            length: #port::LENGTH,
            free: &[#(#free),*],
            attributes: #with_attributes,
            only_with: #only_with,
        }
    })
}
