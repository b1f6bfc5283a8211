//! Laws of contact and wear as Rust expressions. In: [`ContactInfo`]. Out: tokens.

use linkwear_runtime::contact::{Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::{Area, Measure};
use linkwear_runtime::{ContactInfo, GammaRates, WearInfo};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

fn number(value: f64) -> Literal {
    Literal::f64_unsuffixed(value)
}

/// A `ContactInfo` literal.
pub fn contact(own: &ContactInfo, runtime: &TokenStream) -> TokenStream {
    let (joint, ball) = (&*own.joint, own.ball);
    let [radius, length, modulus] = [own.journal_radius, own.length, own.modulus].map(number);
    let [restitution, exponent, floor] = [own.restitution, own.exponent, own.impact_speed_floor].map(number);
    let stiffness = match own.stiffness {
        Stiffness::Given(value) => {
            let value = number(value);
            quote!(Given(#value))
        }
        Stiffness::Hertz { modulus } => {
            let modulus = number(modulus);
            quote!(Hertz { modulus: #modulus })
        }
    };
    let law = match own.law {
        Restitution::LankaraniNikravesh => quote!(LankaraniNikravesh),
        Restitution::Exact => quote!(Exact),
        Restitution::HuntCrossley => quote!(HuntCrossley),
        Restitution::Flores => quote!(Flores),
        Restitution::LeeWang => quote!(LeeWang),
    };
    let friction = match own.friction {
        Some((strength, onset, slope)) => friction(strength, onset, slope, runtime),
        None => quote!(None),
    };
    let wear = match &own.wear {
        Some(info) => wear(info, runtime),
        None => quote!(None),
    };
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
        Strength::Coulomb { coefficient } => {
            let coefficient = number(coefficient);
            quote!(Coulomb { coefficient: #coefficient })
        }
        Strength::Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, exponent } => {
            let [s, k, v, e] =
                [static_coefficient, kinetic_coefficient, stribeck_speed, exponent].map(number);
            quote!(Stribeck {
                static_coefficient: #s, kinetic_coefficient: #k, stribeck_speed: #v, exponent: #e
            })
        }
    };
    let onset = match onset {
        Onset::Smoothed { speed } => {
            let speed = number(speed);
            quote!(Smoothed { speed: #speed })
        }
        Onset::Ambrosio { lower, upper } => {
            let [lower, upper] = [lower, upper].map(number);
            quote!(Ambrosio { lower: #lower, upper: #upper })
        }
    };
    let slope = number(slope);
    quote!(Some((#runtime::contact::Strength::#strength, #runtime::contact::Onset::#onset, #slope)))
}

fn wear(own: &WearInfo, runtime: &TokenStream) -> TokenStream {
    let [k, hardness, feedback] = [own.coefficient, own.hardness, own.feedback].map(number);
    let [threshold, revolutions] = [own.threshold, own.revolutions_per_cycle].map(number);
    let area = match own.area {
        Area::Projected => quote!(Projected),
        Area::Hertz => quote!(Hertz),
        Area::Conformal => quote!(Conformal),
    };
    let measure = match own.measure {
        Some(Measure::Mean) => quote!(Some(#runtime::wear::Measure::Mean)),
        Some(Measure::Maximum) => quote!(Some(#runtime::wear::Measure::Maximum)),
        None => quote!(None),
    };
    let scatter = match own.scatter {
        Some(GammaRates { alpha, beta }) => {
            let [alpha, beta] = [alpha, beta].map(number);
            quote!(Some(#runtime::GammaRates { alpha: #alpha, beta: #beta }))
        }
        None => quote!(None),
    };
    let (profile, bins) = (own.profile, Literal::usize_unsuffixed(own.bins));
    let limit = match own.pressure_speed {
        Some(limit) => {
            let limit = number(limit);
            quote!(Some(#limit))
        }
        None => quote!(None),
    };
    quote! {
        Some(#runtime::WearInfo {
            coefficient: #k, hardness: #hardness, area: #runtime::wear::Area::#area,
            measure: #measure, feedback: #feedback, profile: #profile, bins: #bins,
            threshold: #threshold, revolutions_per_cycle: #revolutions, pressure_speed: #limit,
            scatter: #scatter,
        })
    }
}
