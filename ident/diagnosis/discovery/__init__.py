"""Terms that no list holds: what could be missing at each place of a chain, searched for and tried."""
