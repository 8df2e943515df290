//! Numerical studies as pages: that of the paper, and where methods fail.
//!
//! In: a folder, and how much is computed. Out: in the folder a page `index.html`, and for every figure and table its files. The integrators are named by
//! type, with the systems that a study needs: all of this crate is loops over steps, and is optimized as they are.
//!
//! | module | what it makes |
//! |---|---|
//! | [`paper`] | the study of the paper, with this project's numbers beside the paper's |
//! | [`stability`] | where methods fail, as maps |

pub mod paper;
pub mod stability;
