float tent(int i) { return max(0.0, 4.0 - float(abs(i))); }
