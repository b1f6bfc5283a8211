//! The mechanism's description as tables, and the function that makes a `Description` of them.
//! In: [`Description`]. Out: tokens. User text becomes string literals, which quote escapes.

use linkwear_runtime::wear::Step;
use linkwear_runtime::{
    CoefficientFactor, Description, InputRole, JournalWear, MissionInfo, Motion, SegmentInfo,
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::super::start::Start;
use super::contact::{contact, number, option};

/// `TABLES` and `description()`. Lists are tables of plain tuples, which read and format well. Long ones stand as text in
/// `long`: see [`Long`].
pub fn description(own: &Description, runtime: &TokenStream, long: &mut Long) -> TokenStream {
    let name = &*own.name;
    let parameters = own
        .parameters
        .iter()
        .map(|p| format!("({}, {}, {})", text(&p.name), text(&p.unit), Literal::f64_unsuffixed(p.default)));
    let variable =
        |v: &linkwear_runtime::VariableInfo| format!("({}, {}, {})", text(&v.name), text(&v.unit), v.held);
    let motions = own.motions.iter().map(|motion| match motion {
        Motion::Scalar { driver } => {
            let driver = index(*driver);
            quote!(#runtime::Motion::Scalar { driver: #driver })
        }
        Motion::Rotation => quote!(#runtime::Motion::Rotation),
        Motion::Pose => quote!(#runtime::Motion::Pose),
    });
    let inputs = own.inputs.iter().map(|role| match role {
        InputRole::Value => quote!(#runtime::InputRole::Value),
        InputRole::RateOfPrevious => quote!(#runtime::InputRole::RateOfPrevious),
    });
    let quaternions = own.quaternions.iter().map(|index| Literal::usize_unsuffixed(*index));
    let rows = own.rows.iter().map(|row| {
        format!("({}, {}, {}, {:?})", text(&row.joint), text(&row.meaning), row.angular, row.kept)
    });
    let drivers = own.drivers.iter().map(|driver| format!("({}, {})", text(&driver.joint), driver.angular));
    let channels = own
        .channels
        .iter()
        .map(|channel| format!("({}, {}, {})", text(&channel.name), text(&channel.unit), channel.wraps));
    let contacts = own.contacts.iter().map(|info| contact(info, runtime));
    let missions = own.missions.iter().map(mission);
    let turn_driver = index(own.turn_driver);
    let tables = [
        long.table("PARAMETERS", "(&str, &str, f64)", parameters.collect()),
        table("INPUTS", quote!(#runtime::InputRole), inputs.collect()),
        long.table("COORDINATES", "(&str, &str, bool)", own.coordinates.iter().map(variable).collect()),
        long.table("SPEEDS", "(&str, &str, bool)", own.speeds.iter().map(variable).collect()),
        table("MOTIONS", quote!(#runtime::Motion), motions.collect()),
        table("QUATERNIONS", quote!(usize), quaternions.map(|index| quote!(#index)).collect()),
        long.table("ROWS", "(&str, &str, bool, Option<usize>)", rows.collect()),
        long.table("DRIVERS", "(&str, bool)", drivers.collect()),
        table("CONTACTS", quote!(#runtime::ContactInfo), contacts.collect()),
        table("MISSIONS", quote!(#runtime::MissionRow), missions.collect()),
        long.table("CHANNELS", "(&str, &str, bool)", channels.collect()),
    ];
    let journals = own.journals.iter().map(|JournalWear { contact, ratio }| {
        let (contact, ratio) = (Literal::usize_unsuffixed(*contact), number(*ratio));
        quote!(#runtime::JournalWear { contact: #contact, ratio: #ratio })
    });
    // Where there are none, there is no word of them.
    let coefficients = own.coefficients.iter().map(|CoefficientFactor { contact, steps }| {
        let contact = Literal::usize_unsuffixed(*contact);
        let steps = steps.iter().map(|one| step(one, runtime));
        quote!((#contact, &[#(#steps),*]))
    });
    let guides = own.guides.iter().map(|index| Literal::usize_unsuffixed(*index));
    let guides: Vec<TokenStream> = guides.map(|index| quote!(#index)).collect();
    let has_guides = !guides.is_empty();
    let has_more = has_guides || !(own.journals.is_empty() && own.coefficients.is_empty());
    let wearing = has_more.then_some(quote!(JOURNALS, COEFFICIENTS));
    let more = wearing.as_ref().map(|_| {
        let journals = table("JOURNALS", quote!(#runtime::JournalWear), journals.collect());
        let of = quote!(#runtime::CoefficientRow);
        let coefficients = table("COEFFICIENTS", of, coefficients.collect());
        quote! {
            /// Journals that wear beside their bushes.
            pub #journals
            /// Factors on wear coefficients.
            pub #coefficients
        }
    });
    let sliding = has_guides.then(|| {
        let guides = table("GUIDES", quote!(usize), guides);
        quote! {
            /// Contacts of rods that slide along their bushes or tilt there.
            pub #guides
        }
    });
    let described =
        std::iter::once(quote!(TABLES)).chain(wearing).chain(has_guides.then_some(quote!(GUIDES)));
    quote! {
        #(#tables)*
        #more
        #sliding
        /// Names and units of parameters, coordinates, rows and output columns; laws of contact.
        pub static TABLES: #runtime::Tables = #runtime::Tables {
            name: #name,
            parameters: &PARAMETERS,
            inputs: &INPUTS,
            coordinates: &COORDINATES,
            speeds: &SPEEDS,
            motions: &MOTIONS,
            quaternions: &QUATERNIONS,
            rows: &ROWS,
            drivers: &DRIVERS,
            channels: &CHANNELS,
            turn_driver: #turn_driver,
            contacts: &CONTACTS,
            missions: &MISSIONS,
        };
        #runtime::describe_mechanism!(#(#described),*);
    }
}

/// `START`.
pub fn start(start: &Start, runtime: &TokenStream) -> TokenStream {
    let [state, sizes] = [&start.state, &start.sizes].map(|values| values.iter().map(|value| number(*value)));
    quote! {
        /// A consistent start at t = 0, found when this was generated, with the values of the file.
        pub static START: #runtime::Start = #runtime::Start { state: &[#(#state),*], sizes: &[#(#sizes),*] };
    }
}

/// A step of a factor on a wear coefficient.
fn step(step: &Step, runtime: &TokenStream) -> TokenStream {
    let at = |index: &usize| Literal::usize_unsuffixed(*index);
    let (name, operands) = match step {
        Step::Number(value) => {
            let value = number(*value);
            return quote!(#runtime::wear::Step::Number(#value));
        }
        Step::Given(a) => ("Given", vec![at(a)]),
        Step::Neg(a) => ("Neg", vec![at(a)]),
        Step::Sqrt(a) => ("Sqrt", vec![at(a)]),
        Step::Sin(a) => ("Sin", vec![at(a)]),
        Step::Cos(a) => ("Cos", vec![at(a)]),
        Step::Exp(a) => ("Exp", vec![at(a)]),
        Step::Ln(a) => ("Ln", vec![at(a)]),
        Step::Floor(a) => ("Floor", vec![at(a)]),
        Step::Add(a, b) => ("Add", vec![at(a), at(b)]),
        Step::Sub(a, b) => ("Sub", vec![at(a), at(b)]),
        Step::Mul(a, b) => ("Mul", vec![at(a), at(b)]),
        Step::Div(a, b) => ("Div", vec![at(a), at(b)]),
        Step::Atan2(a, b) => ("Atan2", vec![at(a), at(b)]),
        Step::Select(a, yes, no) => ("Select", vec![at(a), at(yes), at(no)]),
    };
    let name = quote::format_ident!("{name}");
    quote!(#runtime::wear::Step::#name(#(#operands),*))
}

/// A duty cycle as a row.
fn mission(mission: &MissionInfo) -> TokenStream {
    let (name, ordered) = (&*mission.name, mission.ordered);
    let [segments, coarser] = [&mission.segments, &mission.coarser].map(|list| list.iter().map(segment));
    quote!((#name, #ordered, &[#(#segments),*], &[#(#coarser),*]))
}

fn segment(segment: &SegmentInfo) -> TokenStream {
    let (name, amount) = (&*segment.name, number(segment.amount));
    let values = segment.values.iter().map(|(place, value)| {
        let (place, value) = (Literal::usize_unsuffixed(*place), number(*value));
        quote!((#place, #value))
    });
    let factors = segment.factors.iter().map(|(friction, wear)| {
        let [friction, wear] = [*friction, *wear].map(number);
        quote!((#friction, #wear))
    });
    quote!((#name, #amount, &[#(#values),*], &[#(#factors),*]))
}

/// Tables of plain tuples that have many entries: to parse and format them would take as long as all the rest of the source.
#[derive(Default)]
pub struct Long {
    /// The line that stands for a table, and the table.
    tables: Vec<(String, String)>,
}

/// Type of the items that stand for long tables until all else is formatted.
const STAND_IN: &str = "__Table";

/// The formatter puts no more entries than these on one line.
const LONG: usize = 16;

/// Longer lines it breaks, shorter ones surely not.
const SURELY_ONE_LINE: usize = 80;

impl Long {
    /// A private constant array of tuples of literals; of a long one, what stands for it.
    fn table(&mut self, name: &str, of: &str, entries: Vec<String>) -> TokenStream {
        if entries.len() < LONG || entries.iter().any(|entry| entry.len() > SURELY_ONE_LINE) {
            #[expect(clippy::expect_used, reason = "literals and types of the emitter's own")]
            let tokens = |text: &str| text.parse::<TokenStream>().expect("tokens");
            return table(name, tokens(of), entries.iter().map(|entry| tokens(entry)).collect());
        }
        let rows: String = entries.iter().flat_map(|entry| ["    ", entry, ",\n"]).collect();
        let stands = format!("static {name}: {STAND_IN} = [];\n");
        self.tables.push((stands, format!("static {name}: [{of}; {}] = [\n{rows}];\n", entries.len())));
        let [name, of] = [name, STAND_IN].map(|name| quote::format_ident!("{name}"));
        quote!(static #name: #of = [];)
    }

    /// The formatted text with the tables in their places.
    pub fn put_into(&self, formatted: &str) -> String {
        let mut text = String::new();
        for line in formatted.split_inclusive('\n') {
            let table = self.tables.iter().find(|(stands, _)| stands == line);
            text.push_str(table.map_or(line, |(_, table)| table));
        }
        text
    }
}

/// A literal.
fn text(text: &str) -> Literal {
    Literal::string(text)
}

/// A private constant array.
fn table(name: &str, of: TokenStream, entries: Vec<TokenStream>) -> TokenStream {
    let name = quote::format_ident!("{name}");
    let length = Literal::usize_unsuffixed(entries.len());
    quote!(static #name: [#of; #length] = [#(#entries),*];)
}

fn index(value: Option<usize>) -> TokenStream {
    option(value.map(Literal::usize_unsuffixed))
}
