// Photometric quantities of radiometric spectra.
#include <heliograph/photometry.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace helio {
namespace {

TEST(Photometry, TheObserver) {
    EXPECT_EQ(luminousEfficiency(555), 1.0);
    EXPECT_EQ(luminousEfficiency(359), 0.0);
    EXPECT_EQ(luminousEfficiency(831), 0.0);
    EXPECT_EQ(luminousEfficiency(std::nan("")), 0.0);
    EXPECT_NEAR(luminousEfficiency(507.5), 0.5 * (luminousEfficiency(505) + luminousEfficiency(510)), 1e-15);
    double sum = 0;
    for (int nm = 380; nm <= 780; nm += 5) sum += luminousEfficiency(nm);
    EXPECT_NEAR(sum, 21.3713278, 1e-7);  // the published table's
}

TEST(Photometry, MonochromaticLightIs683LumensPerWatt) {
    // A watt in a line at 555 nm, narrower and narrower.
    for (double width : {1.0, 0.1, 0.001}) {
        const std::vector<double> wavelengths = {555 - width, 555, 555 + width}, line = {0, 1 / width, 0};
        EXPECT_NEAR(photometric(wavelengths, line), 683.0, 683 * 2e-3 * width + 1e-4);
    }
    // Equal energy, a watt per nanometre: the integral of V, of 106.85691710 by the table of every nanometre.
    EXPECT_NEAR(photometric(std::vector<double>{360, 830}, std::vector<double>{1, 1}) / 683, 106.85691710,
                1e-2);
    EXPECT_NEAR(photometric(std::vector<double>{360, 830}, std::vector<double>{1, 1}) / 683 / 106.85691710, 1,
                1e-4);
    // Cutting a spectrum in parts changes nothing; what is not seen adds nothing.
    std::vector<double> fine, ones;
    for (double nm = 300; nm <= 900; nm += 3.7) {
        fine.push_back(nm);
        ones.push_back(1);
    }
    EXPECT_NEAR(photometric(fine, ones),
                photometric(std::vector<double>{300, 900}, std::vector<double>{1, 1}), 1e-6);
    EXPECT_EQ(photometric(std::vector<double>{900, 2000}, std::vector<double>{1, 1}), 0.0);
}

}  // namespace
}  // namespace helio
