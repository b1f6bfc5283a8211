//! Laws of contact and wear as Rust expressions. In: [`ContactInfo`]. Out: tokens.

use std::fmt::Debug;

use linkwear_runtime::contact::{Onset, Strength};
use linkwear_runtime::{ContactInfo, GammaRates, WearInfo};
use proc_macro2::{Group, Literal, TokenStream, TokenTree};
use quote::{ToTokens, quote};

/// A number as it is written everywhere.
pub fn number(value: f64) -> Literal {
    Literal::f64_unsuffixed(value)
}

/// A law with its constants as an expression, whichever laws there are: what `Debug` writes, with the numbers as they
/// are written everywhere.
fn law(law: impl Debug) -> TokenStream {
    let Ok(tokens) = format!("{law:?}").parse::<TokenStream>() else { return TokenStream::new() };
    with_plain_numbers(tokens)
}

fn with_plain_numbers(tokens: TokenStream) -> TokenStream {
    let plain = |token: TokenTree| match token {
        TokenTree::Literal(literal) => literal.to_string().parse().map_or(literal, number).into(),
        TokenTree::Group(group) => Group::new(group.delimiter(), with_plain_numbers(group.stream())).into(),
        other => other,
    };
    tokens.into_iter().map(plain).collect()
}

/// `Some` of a value, or `None`.
pub fn option(value: Option<impl ToTokens>) -> TokenStream {
    value.map_or_else(|| quote!(None), |value| quote!(Some(#value)))
}

/// A `ContactInfo` literal.
pub fn contact(info: &ContactInfo, runtime: &TokenStream) -> TokenStream {
    let (joint, ball, restitution_law) = (&*info.joint, info.ball, law(info.law));
    let [radius, length, modulus] = [info.journal_radius, info.length, info.modulus].map(number);
    let [restitution, exponent, floor] =
        [info.restitution, info.exponent, info.impact_speed_floor].map(number);
    let stiffness = law(info.stiffness);
    let friction =
        option(info.friction.map(|(strength, onset, slope)| friction(strength, onset, slope, runtime)));
    let wear = option(info.wear.as_ref().map(|info| wear(info, runtime)));
    quote! {
        #runtime::ContactInfo {
            joint: #runtime::Text::fixed(#joint), ball: #ball, journal_radius: #radius, length: #length,
            modulus: #modulus, stiffness: #runtime::contact::Stiffness::#stiffness,
            law: #runtime::contact::Restitution::#restitution_law, restitution: #restitution, exponent: #exponent,
            impact_speed_floor: #floor, friction: #friction, wear: #wear,
        }
    }
}

fn friction(strength: Strength, onset: Onset, slope: f64, runtime: &TokenStream) -> TokenStream {
    let (strength, onset) = (law(strength), law(onset));
    let slope = number(slope);
    quote!((#runtime::contact::Strength::#strength, #runtime::contact::Onset::#onset, #slope))
}

fn wear(info: &WearInfo, runtime: &TokenStream) -> TokenStream {
    let [k, hardness, feedback] = [info.coefficient, info.hardness, info.feedback].map(number);
    let [threshold, revolutions] = [info.threshold, info.revolutions_per_cycle].map(number);
    let (area, profile, bins) = (law(info.area), info.profile, Literal::usize_unsuffixed(info.bins));
    let measure = option(info.measure.map(|measure| {
        let measure = law(measure);
        quote!(#runtime::wear::Measure::#measure)
    }));
    let scatter = option(info.scatter.map(|GammaRates { alpha, beta }| {
        let [alpha, beta] = [alpha, beta].map(number);
        quote!(#runtime::GammaRates { alpha: #alpha, beta: #beta })
    }));
    let limit = option(info.pressure_speed.map(number));
    let variation = option(info.cycle_variation.map(number));
    quote! {
        #runtime::WearInfo {
            coefficient: #k, hardness: #hardness, area: #runtime::wear::Area::#area,
            measure: #measure, feedback: #feedback, profile: #profile, bins: #bins,
            threshold: #threshold, revolutions_per_cycle: #revolutions, pressure_speed: #limit,
            scatter: #scatter, cycle_variation: #variation,
        }
    }
}
