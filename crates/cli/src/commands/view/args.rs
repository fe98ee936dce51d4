//! What `view` is asked for.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args::{Setting, setting};
use crate::commands::engine::EngineArgs;

/// What devices of the local network may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Lan {
    /// See everything and change nothing
    Look,
    /// Change values of parameters too
    Edit,
}

/// Shows a graph in the browser while it is edited
#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// The graph file
    pub(crate) graph: PathBuf,
    /// The port of the page's address, 0 for any; if left out the first free one from 8137 on
    #[arg(long, value_name = "N")]
    pub(crate) port: Option<u16>,
    /// The address that is listened on; others than this machine's own let others look
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub(crate) host: IpAddr,
    /// Lets devices of the local network look, or with `edit` change values too, once the page has paired them
    #[arg(
        long,
        value_name = "look|edit",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "look",
        conflicts_with = "host"
    )]
    pub(crate) lan: Option<Lan>,
    /// Only prints the page's address, instead of opening it
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Looks for changes twice a second, where the system tells of none: on network drives
    #[arg(long)]
    pub(crate) poll: bool,
    /// Goes on after a run that took too much memory; milliseconds of 1970 when it began
    #[arg(long, value_name = "MS", hide = true)]
    pub(crate) resume: Option<u64>,
    /// The port it goes on at
    #[arg(long, value_name = "N", requires = "resume", hide = true)]
    pub(crate) resume_port: Option<u16>,
    /// Holds a parameter at another value
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) set: Vec<Setting>,
    #[command(flatten)]
    pub(crate) engine: EngineArgs,
}
