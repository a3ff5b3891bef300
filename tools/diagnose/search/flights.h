/// Fits in which a load that flies is a state of the predictor.
#pragma once
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// As long as it exists, runs along the records do not follow such loads: see Trials::follows_flights.
class WithoutFlights {
 public:
  explicit WithoutFlights(Trials& trials) : trials_(trials) { trials_.follows_flights = false; }
  ~WithoutFlights() { trials_.follows_flights = true; }
  WithoutFlights(const WithoutFlights&) = delete;
  WithoutFlights& operator=(const WithoutFlights&) = delete;

 private:
  Trials& trials_;
};

/// An estimate found without following its load, fitted from there and from the usual contact: where the load
/// was not followed, a contact much too hard or too soft can stand for one that comes late.
Estimate fitted_in_flight(Trials& trials, Estimate found);

}  // namespace loopwright::diagnosis
