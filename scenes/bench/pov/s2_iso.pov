// S2: the quartic x^4+y^4+z^4+3(x2y2+x2z2+y2z2)+6xyz-18(x2+y2+z2)+70 = 0. MG = max_gradient, which POV-Ray needs to be told
#version 3.7;
#include "s2_common.inc"
#ifndef (MG) #declare MG = 160; #end
#ifndef (ACC) #declare ACC = 0.0005; #end
isosurface {
  function { pow(x-2,2)*pow(x+2,2)+pow(y-2,2)*pow(y+2,2)+pow(z-2,2)*pow(z+2,2)+3*(x*x*y*y+x*x*z*z+y*y*z*z)+6*x*y*z-10*(x*x+y*y+z*z)+22 }
  contained_by { sphere { 0, 3.55 } }
  accuracy ACC  max_gradient MG 
  texture { Tex }
}
