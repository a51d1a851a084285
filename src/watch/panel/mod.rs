//! The parameters of a scenario, as a person changes them.
