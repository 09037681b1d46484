"""The methods of a search compared by their own answers, before the refinement that they share."""
