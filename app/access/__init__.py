"""Who may do what: roles, tokens, sessions of browsers, and the record of every change."""
