//! This machine's address in the local network.

use std::io;
use std::net::{IpAddr, Ipv4Addr, UdpSocket};

use tessgraph_view::Network;

use super::args::Lan;

/// Where devices of the network find this machine.
///
/// # Errors
/// When it is in none.
pub(super) fn network(lan: Lan) -> io::Result<Network> {
    Ok(Network {
        host: address()?,
        may_edit: lan == Lan::Edit,
    })
}

/// The address that packets to other machines leave from. None is sent: a
/// connection of this kind only notes down where it would lead.
fn address() -> io::Result<IpAddr> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0))?;
    // Of a block that is for documentation, so that it leads nowhere.
    socket.connect((Ipv4Addr::new(203, 0, 113, 1), 9))?;
    let address = socket.local_addr()?.ip();
    if address.is_loopback() || address.is_unspecified() {
        return Err(io::ErrorKind::NetworkUnreachable.into());
    }
    Ok(address)
}
