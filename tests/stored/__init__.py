"""Results as earlier versions wrote them, which every later version reads."""
