//! The mechanism's description and sizes as Rust expressions.
//! In: [`Description`]. Out: tokens. User text becomes string literals, which quote escapes.

use linkwear_runtime::{Description, Motion, Sizes};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// A `Sizes` literal.
pub fn sizes(sizes: Sizes, runtime: &TokenStream) -> TokenStream {
    let Sizes {
        parameters,
        coordinates,
        speeds,
        all_coordinates,
        all_speeds,
        rows,
        all_rows,
        drivers,
        channels,
        workspace,
    } = sizes;
    let numbers = [
        parameters,
        coordinates,
        speeds,
        all_coordinates,
        all_speeds,
        rows,
        all_rows,
        drivers,
        channels,
        workspace,
    ]
    .map(Literal::usize_unsuffixed);
    let [p, q, v, aq, av, r, ar, d, c, w] = numbers;
    quote! {
        #runtime::Sizes {
            parameters: #p, coordinates: #q, speeds: #v, all_coordinates: #aq, all_speeds: #av,
            rows: #r, all_rows: #ar, drivers: #d, channels: #c, workspace: #w,
        }
    }
}

/// A function that returns the description.
pub fn description(own: &Description, runtime: &TokenStream) -> TokenStream {
    let name = text(&own.name);
    let parameters = own.parameters.iter().map(|p| {
        let (name, unit, default) = (text(&p.name), text(&p.unit), Literal::f64_unsuffixed(p.default));
        quote!(#runtime::ParameterInfo { name: #name, unit: #unit, default: #default })
    });
    let variable = |v: &linkwear_runtime::VariableInfo| {
        let (name, unit, held) = (text(&v.name), text(&v.unit), v.held);
        quote!(#runtime::VariableInfo { name: #name, unit: #unit, held: #held })
    };
    let coordinates = own.coordinates.iter().map(variable);
    let speeds = own.speeds.iter().map(variable);
    let motions = own.motions.iter().map(|motion| match motion {
        Motion::Scalar { driver } => {
            let driver = option(*driver);
            quote!(#runtime::Motion::Scalar { driver: #driver })
        }
        Motion::Rotation => quote!(#runtime::Motion::Rotation),
        Motion::Pose => quote!(#runtime::Motion::Pose),
    });
    let quaternions = own.quaternions.iter().map(|index| Literal::usize_unsuffixed(*index));
    let rows = own.rows.iter().map(|row| {
        let (joint, meaning, angular) = (text(&row.joint), text(&row.meaning), row.angular);
        let kept = option(row.kept);
        quote!(#runtime::RowInfo { joint: #joint, meaning: #meaning, angular: #angular, kept: #kept })
    });
    let drivers = own.drivers.iter().map(|driver| {
        let (joint, angular) = (text(&driver.joint), driver.angular);
        quote!(#runtime::DriverInfo { joint: #joint, angular: #angular })
    });
    let channels = own.channels.iter().map(|channel| {
        let (name, unit, wraps) = (text(&channel.name), text(&channel.unit), channel.wraps);
        quote!(#runtime::Channel { name: #name, unit: #unit, wraps: #wraps })
    });
    let turn_driver = option(own.turn_driver);
    quote! {
        /// Names and units of parameters, coordinates, rows and output columns.
        #[must_use]
        pub fn description() -> &'static #runtime::Description {
            use ::std::borrow::Cow::Borrowed;
            static DESCRIPTION: ::std::sync::LazyLock<#runtime::Description> =
                ::std::sync::LazyLock::new(|| #runtime::Description {
                    name: #name,
                    parameters: vec![#(#parameters),*].into(),
                    coordinates: vec![#(#coordinates),*].into(),
                    speeds: vec![#(#speeds),*].into(),
                    motions: vec![#(#motions),*].into(),
                    quaternions: vec![#(#quaternions),*].into(),
                    rows: vec![#(#rows),*].into(),
                    drivers: vec![#(#drivers),*].into(),
                    channels: vec![#(#channels),*].into(),
                    turn_driver: #turn_driver,
                });
            &DESCRIPTION
        }
    }
}

fn text(text: &str) -> TokenStream {
    quote!(Borrowed(#text))
}

fn option(index: Option<usize>) -> TokenStream {
    match index {
        Some(index) => {
            let index = Literal::usize_unsuffixed(index);
            quote!(Some(#index))
        }
        None => quote!(None),
    }
}
