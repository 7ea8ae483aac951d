//! Laws that joined bodies keep.
