//! `#[derive(Choice)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Data, DeriveInput, Error, Fields, Path, Result};

use crate::attributes;

pub(crate) fn expand(item: &DeriveInput) -> Result<TokenStream> {
    let ident = &item.ident;
    let Data::Enum(data) = &item.data else {
        return Err(Error::new(ident.span(), "only enums can be choices"));
    };
    let (mut specs, mut variants, mut names) = (Vec::new(), Vec::new(), Vec::new());
    for variant in &data.variants {
        if !matches!(variant.fields, Fields::Unit) {
            return Err(Error::new(variant.ident.span(), "choices carry no payload"));
        }
        let doc = attributes::doc(&variant.attrs, variant.ident.span(), "a choice")?;
        let name = variant.ident.to_string();
        specs.push(quote!(::tessgraph_graph::value::ChoiceSpec { name: #name, doc: #doc }));
        variants.push(&variant.ident);
        names.push(name);
    }
    let into = into_path(item)?.map(|path| {
        quote! {
            impl ::core::convert::From<#ident> for #path {
                fn from(choice: #ident) -> Self {
                    match choice {
                        #(#ident::#variants => Self::#variants),*
                    }
                }
            }
        }
    });
    Ok(quote! {
        impl ::tessgraph_graph::value::InputType for #ident {
            const KIND: ::tessgraph_graph::Kind = ::tessgraph_graph::Kind::Choice;
            const CHOICES: &'static [::tessgraph_graph::value::ChoiceSpec] = &[#(#specs),*];

            fn from_value(value: ::tessgraph_graph::Value) -> ::core::option::Option<Self> {
                match value {
                    #(::tessgraph_graph::Value::Choice(#names) => Some(Self::#variants),)*
                    _ => None,
                }
            }
        }

        impl ::tessgraph_graph::value::InputDefault for #ident {
            type Literal = Self;

            fn default_value(literal: Self) -> ::tessgraph_graph::Value {
                ::tessgraph_graph::Value::Choice(match literal {
                    #(Self::#variants => #names),*
                })
            }
        }

        #into
    })
}

/// The path in `#[choice(into = path)]`.
fn into_path(item: &DeriveInput) -> Result<Option<Path>> {
    let mut path = None;
    attributes::each(&item.attrs, "choice", |meta| {
        if !meta.path.is_ident("into") {
            return Err(meta.error("expected `into = path`"));
        }
        path = Some(meta.value()?.parse()?);
        Ok(())
    })?;
    Ok(path)
}
