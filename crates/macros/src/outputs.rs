//! `#[derive(Outputs)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Field, Ident, Result};

use crate::attributes::{self, Options};

pub(crate) fn expand(item: &DeriveInput) -> Result<TokenStream> {
    let ident = &item.ident;
    let fields = attributes::fields(item)?;
    let mut specs = fields
        .iter()
        .map(|(name, f)| spec(name, f))
        .collect::<Result<Vec<_>>>()?;
    let values = fields
        .iter()
        .map(|(name, _)| quote!(::tessgraph_graph::value::OutputType::into_value(self.#name)));
    let mut values = quote!(::std::vec![#(#values),*]);
    let mut report = false;
    attributes::each(&item.attrs, "outputs", |meta| {
        match meta.path.is_ident("report") {
            true => {
                report = true;
                Ok(())
            }
            false => Err(meta.error("expected `report`")),
        }
    })?;
    if report {
        specs.insert(0, quote!(::tessgraph_graph::node::REPORT));
        let outputs = quote!(<Self as ::tessgraph_graph::Outputs>::OUTPUTS);
        values = quote!(::tessgraph_graph::node::with_report(#outputs, #values));
    }
    Ok(quote! {
        impl ::tessgraph_graph::Outputs for #ident {
            const OUTPUTS: &'static [::tessgraph_graph::node::OutputSpec] = &[#(#specs),*];

            fn into_values(self) -> ::std::vec::Vec<::tessgraph_graph::Value> {
                #values
            }
        }
    })
}

fn spec(ident: &Ident, field: &Field) -> Result<TokenStream> {
    let doc = attributes::doc(&field.attrs, ident.span(), "a result")?;
    let (name, ty) = (ident.to_string(), &field.ty);
    let options = Options::read(&field.attrs, "output")?;
    let quantity = options.quantity();
    let faults = match options.faults {
        None => quote!(::std::option::Option::None),
        Some(without) => {
            let without = without.iter().map(Ident::to_string);
            quote!(::std::option::Option::Some(&[#(#without),*]))
        }
    };
    Ok(quote! {
        ::tessgraph_graph::node::OutputSpec {
            name: #name,
            doc: #doc,
            kind: <#ty as ::tessgraph_graph::value::OutputType>::KIND,
            quantity: #quantity,
            faults: #faults,
        }
    })
}
