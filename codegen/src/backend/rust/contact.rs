//! Laws of contact and wear as Rust expressions. In: [`ContactInfo`]. Out: tokens.

use std::fmt::Debug;

use linkwear_runtime::contact::{Onset, Stiffness, Strength};
use linkwear_runtime::{ContactInfo, GammaRates, WearInfo};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

fn number(value: f64) -> Literal {
    Literal::f64_unsuffixed(value)
}

/// The variant of an enumeration of laws, whichever laws there are.
fn variant(law: impl Debug) -> Ident {
    format_ident!("{}", format!("{law:?}"))
}

/// A variant with fields.
fn with_fields<const N: usize>(name: &str, fields: [(&str, f64); N]) -> TokenStream {
    let name = format_ident!("{name}");
    let fields = fields.map(|(field, value)| {
        let (field, value) = (format_ident!("{field}"), number(value));
        quote!(#field: #value)
    });
    quote!(#name { #(#fields),* })
}

/// `Some` of a value, or `None`.
pub fn option(value: Option<impl ToTokens>) -> TokenStream {
    value.map_or_else(|| quote!(None), |value| quote!(Some(#value)))
}

/// A `ContactInfo` literal.
pub fn contact(info: &ContactInfo, runtime: &TokenStream) -> TokenStream {
    let (joint, ball, law) = (&*info.joint, info.ball, variant(info.law));
    let [radius, length, modulus] = [info.journal_radius, info.length, info.modulus].map(number);
    let [restitution, exponent, floor] =
        [info.restitution, info.exponent, info.impact_speed_floor].map(number);
    let stiffness = match info.stiffness {
        Stiffness::Given(value) => {
            let value = number(value);
            quote!(Given(#value))
        }
        Stiffness::Hertz { modulus } => with_fields("Hertz", [("modulus", modulus)]),
    };
    let friction =
        option(info.friction.map(|(strength, onset, slope)| friction(strength, onset, slope, runtime)));
    let wear = option(info.wear.as_ref().map(|info| wear(info, runtime)));
    quote! {
        #runtime::ContactInfo {
            joint: ::std::borrow::Cow::Borrowed(#joint), ball: #ball, journal_radius: #radius, length: #length,
            modulus: #modulus, stiffness: #runtime::contact::Stiffness::#stiffness,
            law: #runtime::contact::Restitution::#law, restitution: #restitution, exponent: #exponent,
            impact_speed_floor: #floor, friction: #friction, wear: #wear,
        }
    }
}

fn friction(strength: Strength, onset: Onset, slope: f64, runtime: &TokenStream) -> TokenStream {
    let strength = match strength {
        Strength::Coulomb { coefficient } => with_fields("Coulomb", [("coefficient", coefficient)]),
        Strength::Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, exponent } => {
            let fields = [
                ("static_coefficient", static_coefficient),
                ("kinetic_coefficient", kinetic_coefficient),
                ("stribeck_speed", stribeck_speed),
                ("exponent", exponent),
            ];
            with_fields("Stribeck", fields)
        }
    };
    let onset = match onset {
        Onset::Smoothed { speed } => with_fields("Smoothed", [("speed", speed)]),
        Onset::Ambrosio { lower, upper } => with_fields("Ambrosio", [("lower", lower), ("upper", upper)]),
    };
    let slope = number(slope);
    quote!((#runtime::contact::Strength::#strength, #runtime::contact::Onset::#onset, #slope))
}

fn wear(info: &WearInfo, runtime: &TokenStream) -> TokenStream {
    let [k, hardness, feedback] = [info.coefficient, info.hardness, info.feedback].map(number);
    let [threshold, revolutions] = [info.threshold, info.revolutions_per_cycle].map(number);
    let (area, profile, bins) = (variant(info.area), info.profile, Literal::usize_unsuffixed(info.bins));
    let measure = option(info.measure.map(|measure| {
        let measure = variant(measure);
        quote!(#runtime::wear::Measure::#measure)
    }));
    let scatter = option(info.scatter.map(|GammaRates { alpha, beta }| {
        let [alpha, beta] = [alpha, beta].map(number);
        quote!(#runtime::GammaRates { alpha: #alpha, beta: #beta })
    }));
    let limit = option(info.pressure_speed.map(number));
    quote! {
        #runtime::WearInfo {
            coefficient: #k, hardness: #hardness, area: #runtime::wear::Area::#area,
            measure: #measure, feedback: #feedback, profile: #profile, bins: #bins,
            threshold: #threshold, revolutions_per_cycle: #revolutions, pressure_speed: #limit,
            scatter: #scatter,
        }
    }
}
