//! Forces that ask for accelerations or for forces of joints at the same instant.
//! In: their laws. Out: a symbol for each such force and for all that they ask for. Never solves.

use std::cell::RefCell;

use crate::expr::{Expr, Scope};
use crate::model::Response;

/// What is asked for, and the forces that ask, as symbols until the instant is solved for them.
#[derive(Debug, Default)]
pub struct Responses<'g> {
    asked: RefCell<Vec<(Response, Expr<'g>)>>,
    unknowns: RefCell<Vec<Expr<'g>>>,
    /// Of the instant that is being derived, in the order of the unknowns.
    laws: RefCell<Vec<Expr<'g>>>,
}

impl<'g> Responses<'g> {
    /// The symbol of what is asked for.
    pub fn symbol(&self, g: &'g Scope, response: Response) -> Expr<'g> {
        let known = self.asked.borrow().iter().find(|(known, _)| *known == response).map(|known| known.1);
        known.unwrap_or_else(|| {
            let symbol = g.symbol(format!("response{}", self.asked.borrow().len() + 1));
            self.asked.borrow_mut().push((response, symbol));
            symbol
        })
    }

    /// The symbol of the next force whose law, over symbols of what it asks for, this is.
    pub fn unknown(&self, g: &'g Scope, law: Expr<'g>) -> Expr<'g> {
        let number = self.laws.borrow().len();
        self.laws.borrow_mut().push(law);
        if self.unknowns.borrow().len() == number {
            let symbol = g.symbol(format!("responding{}", number + 1));
            self.unknowns.borrow_mut().push(symbol);
        }
        self.unknowns.borrow()[number]
    }

    /// The laws since this was asked last: every instant derives them anew, in one order.
    pub fn take_laws(&self) -> Vec<Expr<'g>> {
        self.laws.take()
    }

    /// All that is asked for, with the symbols.
    pub fn asked(&self) -> Vec<(Response, Expr<'g>)> {
        self.asked.borrow().clone()
    }

    /// The symbols of the forces that ask.
    pub fn unknowns(&self) -> Vec<Expr<'g>> {
        self.unknowns.borrow().clone()
    }
}
