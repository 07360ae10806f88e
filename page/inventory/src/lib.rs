//! In place of the library of this name, which Bevy collects the registrations of all its reflected types with. The game reflects none, but
//! what is collected cannot be left out of a program: it was a third of the page's. Here nothing is collected.
#![no_std]

mod kind {
    /// A list of what was submitted: nothing.
    #[allow(non_camel_case_types, reason = "the library's name for it")]
    #[derive(Debug)]
    pub enum iter<T> {
        /// As a value: `inventory::iter::<T>`.
        iter,
        /// Never made; it says what of.
        Never(core::convert::Infallible, core::marker::PhantomData<T>),
    }
}
pub use kind::iter;
pub use kind::iter::*;

impl<T: 'static> IntoIterator for iter<T> {
    type Item = &'static T;
    type IntoIter = core::iter::Empty<&'static T>;

    fn into_iter(self) -> Self::IntoIter {
        core::iter::empty()
    }
}

/// Has nothing collected.
#[macro_export]
macro_rules! collect {
    ($kind:ty) => {};
}

/// Drops what is submitted.
#[macro_export]
macro_rules! submit {
    ($($thing:tt)*) => {};
}
