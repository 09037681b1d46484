"""Jobs: what is queued, worked off step by step, watched and cancelled."""
