// Terms that the rows that were fitted ask for, and those that were held out do not.
#include "tools/diagnose/verdict/held_out_terms.h"
#include <gmock/gmock.h>
#include "tests/tools/diagnose/plants.h"
#include "tests/tools/diagnose/site_term.h"

namespace loopwright::held_out_terms_test {
namespace {

using namespace diagnosis;
using testing::ElementsAre, testing::IsEmpty;

Plant hardening() {
  Oscillator m;
  m.force = [](double x, double) { return 6000 * x * x * x; };
  return oscillator(m, 61);
}

class HeldOutTerms : public testing::Test {
 protected:
  HeldOutTerms() {
    found.factors.assign(model.parameters().size(), 1.0), found.is_free.assign(found.factors.size(), false);
    found.terms = {term("cube", "mass.position", -6000)};
    found.noise = filter.guess_noise();
    SitePass pass;
    EXPECT_TRUE(fitter.pass(found, true, pass));
    filter.learn_scales(pass), filter.choose_substeps(pass);
    fitter.fit_noise(found);
  }
  SiteTerm term(std::string_view shape, std::string_view variable, double coefficient) const {
    return term_at_net_sum(model, shape, variable, coefficient);
  }

  RecordedPlant files{hardening()};
  SiteModel model{files.diagram(), {files.experiment()}, {}};
  SiteFilter filter{model};
  SiteFitter fitter{filter, model.record().rows(), [] { return false; }};
  SiteHypothesis found;
};

TEST_F(HeldOutTerms, SpeakForATermThatIsThere) { EXPECT_THAT(contradicted_terms(fitter, found), IsEmpty()); }
TEST_F(HeldOutTerms, SpeakAgainstOneThatIsNot) {
  found.terms.push_back(term("constant", "", 0.03));
  EXPECT_THAT(contradicted_terms(fitter, found), ElementsAre(1));
}
TEST_F(HeldOutTerms, SayNothingAboutOneThatTheyDoNotShow) {
  found.terms.push_back(term("constant", "", 1e-4));
  EXPECT_THAT(contradicted_terms(fitter, found), IsEmpty());
}

}  // namespace
}  // namespace loopwright::held_out_terms_test
