//! Tables of generated code whose journals wear and whose wear coefficients vary, as generators write them.

use linkwear_runtime::wear::{Step, factor};
use linkwear_runtime::{CoefficientRow, JournalWear, Tables};

static JOURNALS: [JournalWear; 1] = [JournalWear { contact: 1, ratio: 0.5 }];
static COEFFICIENTS: [CoefficientRow; 1] = [(0, &[Step::Given(0), Step::Number(2.0), Step::Mul(0, 1)])];
static TABLES: Tables = Tables {
    name: "wearing",
    parameters: &[],
    inputs: &[],
    coordinates: &[],
    speeds: &[],
    motions: &[],
    quaternions: &[],
    rows: &[],
    drivers: &[],
    channels: &[],
    turn_driver: None,
    contacts: &[],
    missions: &[],
};

linkwear_runtime::describe_mechanism!(TABLES, JOURNALS, COEFFICIENTS);

#[test]
fn a_description_has_what_its_tables_say_of_wear() {
    let made = description();
    assert_eq!((made.journal_ratio(0), made.journal_ratio(1)), (None, Some(0.5)));
    let [own] = &made.coefficients[..] else { panic!("{:?}", made.coefficients) };
    assert_eq!((own.contact, factor(&own.steps, &[3.0, 0.0])), (0, 6.0));
}
