float weight(int i) { return exp(-float(i * i) / 8.0); }
